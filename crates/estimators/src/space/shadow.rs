//! Shadow rays from scatterings, side by side: event-based tracking of their transmittances.
//!
//! ```text
//! T̂ = e^(−σ_c ℓ) ∏ (1 − (σ_t − σ_c)/σ̂)   ratio and residual-ratio tracking
//! T̂ = [no u σ̂ < σ_t]                      delta tracking
//! ```
//!
//! A flight along a shadow ray is a step like any other: it shares its logarithm and its lookup with the
//! walks of the other lanes.

use super::connection;
use media::{Batches, Volume};
use numeric::geometry::exit::{along, rows};
use numeric::geometry::{Bounds, Point, Ray};
use numeric::pack::WIDTH;
use numeric::rng::Random;
use numeric::{Kept, Lane, Mask, Span, kept};
use theory::single::Tracking;

/// Settings of shadow rays: through a volume, from within its bounds.
#[derive(Clone, Copy)]
pub struct ShadowRays<'a> {
    /// The volume.
    pub volume: &'a Volume,
    /// Bounds of the volume.
    pub bounds: Bounds,
    /// The tracking of transmittances.
    pub tracking: Tracking,
    /// `1/σ̂`; 1 where nothing is tracked.
    mean_free_path: f64,
    /// σ_t, if the volume has one value. Found once, for it is computed from all facts of the volume.
    extinction: Option<f64>,
}

/// Light as seen from a point, or from eight.
#[derive(Clone, Copy)]
pub struct VisibleLight<L> {
    /// Direction of the light, a unit vector.
    pub direction: [L; 3],
    /// Share of the light without a medium.
    pub share: L,
    /// Distance of the light.
    pub distance: L,
}

/// Aims of shadow rays: an angle from an axis, at any azimuth.
#[derive(Clone, Copy)]
pub struct Aim<L> {
    /// A unit vector.
    pub axis: [L; 3],
    /// The cosine with it.
    pub cosine: L,
    /// The share of the light without a medium.
    pub share: L,
    /// The distance of the light's centre.
    pub distance: L,
}

impl<L: Lane> Aim<L> {
    /// Light in a drawn `direction`. A light with a surface has a `stop`: lanes that miss the surface, and its
    /// distance for the others. Without `stop` the light is infinitely far.
    #[inline(always)]
    pub fn light(self, direction: [L; 3], stop: Option<(L::Mask, L)>) -> VisibleLight<L> {
        let Self { cosine, share, distance, .. } = self;
        // A direction at the edge may miss by rounding: its ray then ends at the nearest point.
        let distance = match stop {
            Some((misses, near)) => L::select(misses, distance * cosine, near),
            None => distance.each(f64::INFINITY),
        };
        VisibleLight { direction, share, distance }
    }
}

/// Lanes with light that shadow rays have found, and its transmittance.
pub type LitLanes<L> = (<L as Lane>::Mask, L);

kept! {
    /// Shadow rays of walks, at most one of each, from where its flight begins.
    pub struct Shadows<L> {
        /// Lanes with a shadow ray in flight.
        pub on: L::Mask,
        direction: [L; 3],
        t: L,
        end: L,
        /// T̂ so far, where it is tracked.
        pub through: L,
        /// The weight times the share of the light.
        worth: L,
    }
}

impl<'a> ShadowRays<'a> {
    /// Shadow rays through a volume, from within bounds.
    pub fn new(volume: &'a Volume, bounds: Bounds, tracking: Tracking) -> Self {
        let sampling = match tracking {
            Tracking::Ratio { sampling, .. } | Tracking::Delta { sampling } => sampling,
            Tracking::Exact => 1.0,
        };
        let extinction = volume.facts().single_value;
        Self { volume, bounds, tracking, mean_free_path: 1.0 / sampling, extinction }
    }

    /// The exact transmittance of intervals of rays within the volume, for the lanes in `which`; 1 for the others.
    /// `fields` has the formula of a field for lanes, if there is one.
    #[inline(always)]
    pub fn exact<L: Lane>(
        &self,
        fields: Option<&Batches>,
        which: L::Mask,
        [origin, direction]: [[L; 3]; 2],
        [from, to]: [L; 2],
    ) -> L {
        let one = from.each(1.0);
        if !which.any() {
            return one;
        }
        if let Some(value) = self.extinction {
            return L::select(which, (-((to - from) * value)).exp(), one);
        }
        let ([a, b, c], [x, y, z]) = (origin, direction);
        if let Some(depths) = fields.and_then(
            #[inline(always)]
            |fields| fields.depths(&[a, b, c, x, y, z, from, to]),
        ) {
            return L::select(which, (-depths).exp(), one);
        }
        let (lines, [start, ..], bits) =
            ([rows(origin), rows(direction)], rows([from; 3]), which.bits());
        let through = to.replaced(|ends| self.one_by_one(bits, &lines, ends, &start));
        L::select(which, through, one)
    }

    /// Replaces the ends of intervals by their transmittances, for the lanes in `which`, as bits.
    #[inline(never)]
    fn one_by_one(
        &self,
        which: u64,
        rays: &[[[f64; WIDTH]; 3]; 2],
        ends: &mut [f64],
        from: &[f64],
    ) {
        for (lane, end) in ends.iter_mut().enumerate().filter(|(lane, _)| which >> lane & 1 == 1) {
            let [origin, direction] = rays.map(|rows| Point(rows.map(|row| row[lane])));
            let inside = Span::new(from[lane], *end);
            let ray = Ray { origin, direction, length: f64::INFINITY };
            *end = connection::exact(self.volume, &ray, inside);
        }
    }
}

impl<L: Lane> Shadows<L> {
    /// No shadow ray.
    #[inline(always)]
    pub fn new(zero: L) -> Self {
        let on = zero.below(zero);
        Self { on, direction: [zero; 3], t: zero, end: zero, through: zero, worth: zero }
    }

    /// Begins the rays of the lanes in `which` at places with weights, with intervals of their lines within the
    /// bounds. Returns the light of lanes that need no tracking, and its transmittance.
    #[inline(always)]
    pub fn cast(
        &mut self,
        (rays, fields): (&ShadowRays, Option<&Batches>),
        which: L::Mask,
        light: &VisibleLight<L>,
        (origin, weight): ([L; 3], L),
        [from, to]: [L; 2],
    ) -> (LitLanes<L>, L) {
        let one = weight.each(1.0);
        let (from, end) = (from.or_more(weight.each(0.0)), light.distance.or_less(to));
        let is_blocked = which & from.below(end);
        let worth = weight * light.share;
        let control = match rays.tracking {
            Tracking::Ratio { control, .. } => control,
            Tracking::Delta { .. } => 0.0,
            Tracking::Exact => {
                let through =
                    rays.exact(fields, is_blocked, [origin, light.direction], [from, end]);
                return ((which, worth * through), through);
            }
        };
        self.on |= is_blocked;
        self.direction.set_where(is_blocked, light.direction);
        self.t.set_where(is_blocked, from);
        self.end.set_where(is_blocked, end);
        self.worth.set_where(is_blocked, worth);
        let through = if control == 0.0 { one } else { ((end - from) * -control).exp() };
        self.through.set_where(is_blocked, through);
        ((which & !is_blocked, worth), one)
    }

    /// Flies an optical depth through σ̂; returns places, and the lanes that are still on their rays.
    #[inline(always)]
    pub fn fly(&mut self, rays: &ShadowRays, origin: [L; 3], depth: L) -> ([L; 3], L::Mask) {
        self.t = self.t + depth * rays.mean_free_path;
        (along(origin, self.direction, self.t), self.on & !self.end.at_most(self.t))
    }

    /// Handles collisions at places, given σ_t; returns the light of the rays that have come to their ends or are
    /// absorbed.
    #[inline(always)]
    pub fn collide(
        &mut self,
        rays: &ShadowRays,
        random: &mut impl Random<L>,
        (place, inside): ([L; 3], L::Mask),
        extinction: L,
    ) -> LitLanes<L> {
        let zero = extinction.each(0.0);
        let extinction = match rays.bounds {
            Bounds::Sphere { centre, radius } => {
                let distance = centre.square_to(place, 1.0).root();
                L::select(distance.at_most(zero.each(radius)), extinction, zero)
            }
            // Lookups clip to boxes.
            Bounds::Everywhere | Bounds::Box(_) => extinction,
        };
        let mut ends = self.on & !inside;
        match rays.tracking {
            Tracking::Ratio { control, .. } => {
                let kept = (extinction - control) * rays.mean_free_path;
                self.through.scale_where(inside, kept.one_minus());
            }
            Tracking::Delta { sampling } => {
                let number = random.uniform_where(inside);
                let is_absorbed = inside & (number * sampling).below(extinction);
                self.through.set_where(is_absorbed, zero);
                ends |= is_absorbed;
            }
            Tracking::Exact => {}
        }
        self.on &= !ends;
        (ends, self.worth * self.through)
    }
}

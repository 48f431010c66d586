//! Shadow rays from scatterings side by side: event-based tracking of what next-event estimation asks for.
//!
//! ```text
//! T̂ = e^(−σ_c ℓ) ∏ (1 − (σ_t − σ_c)/σ̂)   ratio and residual-ratio tracking
//! T̂ = [no u σ̂ < σ_t]                      delta tracking
//! ```
//!
//! A flight along a shadow ray is a step like any other: it shares its logarithm and its lookup with the
//! walks of the other lanes. Bit for bit what
//! [`transmittance`](crate::single_scattering::connection::transmittance) finds.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::exit::{Points, rows};
use crate::kernels::packet::bank::Numbers;
use media::{Batches, Volume};
use numeric::geometry::{Bounds, Point, Ray};
use numeric::pack::WIDTH;
use numeric::{Lane, Span};
use theory::single::Tracking;

/// How shadow rays are cast: through a volume, from within its bounds.
pub struct ShadowRays<'a> {
    /// What is in the way.
    pub volume: &'a Volume,
    /// Where it is.
    pub bounds: Bounds,
    /// How the transmittance is found.
    pub tracking: Tracking,
    /// `1/σ̂`; 1 where nothing is tracked.
    mean_free_path: f64,
}

/// Light as a point sees it, or eight.
#[derive(Clone, Copy)]
pub struct Light<L> {
    /// In which direction it is looked for, a unit vector.
    pub direction: [L; 3],
    /// What it is worth without a medium.
    pub share: L,
    /// How far it is.
    pub distance: L,
}

/// How shadow rays are aimed: at an angle from an axis, at any azimuth.
#[derive(Clone, Copy)]
pub struct Aim<L> {
    /// A unit vector.
    pub axis: [L; 3],
    /// The cosine with it.
    pub cosine: L,
    /// What the light is worth without a medium.
    pub share: L,
    /// How far it is to the light's centre.
    pub distance: L,
}

impl<L: Lane> Aim<L> {
    /// The light in a direction that was drawn so: its surface, which is passed by some and met by the others so far
    /// away, or one without end.
    #[inline(always)]
    pub fn light(self, direction: [L; 3], stop: Option<(L::Mask, L)>) -> Light<L> {
        let Self { cosine, share, distance, .. } = self;
        // A direction at the edge may miss by rounding: it ends at the point of the edge.
        let distance = match stop {
            Some((misses, near)) => L::select(misses, distance * cosine, near),
            None => distance.each(f64::INFINITY),
        };
        Light { direction, share, distance }
    }
}

/// Light that has been found, and by which rays.
pub type Found<S> = (mask64x8<S>, f64x8<S>);

/// The shadow rays of eight particles: one each at most, from where its flight begins.
#[derive(Clone, Copy)]
pub struct Shadows<S: Simd> {
    /// Which particles cast one.
    pub on: mask64x8<S>,
    direction: Points<S>,
    t: f64x8<S>,
    end: f64x8<S>,
    /// T̂ so far, where it is tracked.
    pub through: f64x8<S>,
    /// The weight times what the light is worth.
    worth: f64x8<S>,
}

impl<'a> ShadowRays<'a> {
    /// Those through a volume, from within bounds.
    pub fn new(volume: &'a Volume, bounds: Bounds, tracking: Tracking) -> Self {
        let sampling = match tracking {
            Tracking::Ratio { sampling, .. } | Tracking::Delta { sampling } => sampling,
            Tracking::Exact => 1.0,
        };
        Self { volume, bounds, tracking, mean_free_path: 1.0 / sampling }
    }

    /// In closed form, ray by ray, for those whose bits are set.
    #[inline(never)]
    fn exact(&self, which: u64, rays: &[[[f64; WIDTH]; 3]; 2], ends: &mut [f64], from: &[f64]) {
        for (lane, end) in ends.iter_mut().enumerate().filter(|(lane, _)| which >> lane & 1 == 1) {
            let [origin, direction] = rays.map(|rows| Point(rows.map(|row| row[lane])));
            let inside = Span::new(from[lane], *end);
            let ray = Ray { origin, direction, length: f64::INFINITY };
            let profile = self.volume.along(&ray, inside);
            *end = Lane::exp(-profile.optical_depth(inside).value);
        }
    }
}

impl<S: Simd> Shadows<S> {
    /// None.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let on = zero.below(zero);
        Self { on, direction: [zero; 3], t: zero, end: zero, through: zero, worth: zero }
    }

    /// The rays that a mask names begin at places with weights, their lines within the bounds from and to; what needs
    /// no tracking is found at once.
    #[inline(always)]
    pub fn cast(
        &mut self,
        (rays, field): (&ShadowRays, &Batches),
        which: mask64x8<S>,
        light: &Light<f64x8<S>>,
        (origin, weight): (Points<S>, f64x8<S>),
        [from, to]: [f64x8<S>; 2],
    ) -> Found<S> {
        let (zero, one) = (weight.each(0.0), weight.each(1.0));
        let (from, end) = (from.or_more(zero), light.distance.or_less(to));
        let is_blocked = which & from.below(end);
        let worth = weight * light.share;
        let control = match rays.tracking {
            Tracking::Ratio { control, .. } => control,
            Tracking::Delta { .. } => 0.0,
            Tracking::Exact => {
                let blocked = is_blocked.to_bitmask();
                if blocked == 0 {
                    return (which, worth);
                }
                if let Some(value) = rays.volume.single_value() {
                    let through = (-((end - from) * value)).exp();
                    return (which, worth * Lane::select(is_blocked, through, one));
                }
                let ([a, b, c], [x, y, z]) = (origin, light.direction);
                if let Some(depths) = field.depths(&[a, b, c, x, y, z, from, end]) {
                    let through = (-depths).exp();
                    return (which, worth * Lane::select(is_blocked, through, one));
                }
                let (lines, [start, ..]) = ([rows(origin), rows(light.direction)], rows([from; 3]));
                let through = end.replaced(|ends| rays.exact(blocked, &lines, ends, &start));
                return (which, worth * Lane::select(is_blocked, through, one));
            }
        };
        self.on |= is_blocked;
        for (axis, direction) in self.direction.iter_mut().enumerate() {
            *direction = Lane::select(is_blocked, light.direction[axis], *direction);
        }
        self.t = Lane::select(is_blocked, from, self.t);
        self.end = Lane::select(is_blocked, end, self.end);
        self.worth = Lane::select(is_blocked, worth, self.worth);
        let through = if control == 0.0 { one } else { ((end - from) * -control).exp() };
        self.through = Lane::select(is_blocked, through, self.through);
        (which & !is_blocked, worth)
    }

    /// Each flies an optical depth through σ̂; answers where, and whether it is still on the ray.
    #[inline(always)]
    pub fn fly(
        &mut self,
        rays: &ShadowRays,
        [a, b, c]: Points<S>,
        depth: f64x8<S>,
    ) -> (Points<S>, mask64x8<S>) {
        self.t += depth * rays.mean_free_path;
        let ([x, y, z], t) = (self.direction, self.t);
        ([a + x * t, b + y * t, c + z * t], self.on & !self.end.at_most(t))
    }

    /// What becomes of each, given σ_t where it has come to: those that have come to their ends, or are
    /// absorbed, have found what they bring.
    #[inline(always)]
    pub fn collide(
        &mut self,
        rays: &ShadowRays,
        numbers: &mut Numbers<S>,
        (place, inside): (Points<S>, mask64x8<S>),
        extinction: f64x8<S>,
    ) -> Found<S> {
        let zero = extinction.each(0.0);
        let extinction = match rays.bounds {
            Bounds::Sphere { centre, radius } => {
                let distance = centre.square_to(place, 1.0).root();
                Lane::select(distance.at_most(zero.each(radius)), extinction, zero)
            }
            // Boxes are clipped by who looks up.
            Bounds::Everywhere | Bounds::Box(_) => extinction,
        };
        let mut ends = self.on & !inside;
        match rays.tracking {
            Tracking::Ratio { control, .. } => {
                let kept = zero.each(1.0) - (extinction - control) * rays.mean_free_path;
                self.through = Lane::select(inside, self.through * kept, self.through);
            }
            Tracking::Delta { sampling } => {
                let number = numbers.uniform_where(inside);
                let is_absorbed = inside & (number * sampling).below(extinction);
                self.through = Lane::select(is_absorbed, zero, self.through);
                ends |= is_absorbed;
            }
            Tracking::Exact => {}
        }
        self.on &= !ends;
        (ends, self.worth * self.through)
    }
}

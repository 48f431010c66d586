//! A walk from the eye with hits, shadow rays and connections that share the paths each of them can make.
//!
//! A path ends with a scattering y; x is the scattering before it, if there is one. Its last segment leads from y
//! to the light. The part before x is common to all techniques. Relative to a walk that hits the light, they make
//! the path with the densities
//!
//! ```text
//! hit           1, or 0 for a distant light
//! shadow ray    1/(q ν),  q = p(ω)/p_nee = Ω/4π of the light as seen from y
//! connection    4 d²/(a ρ² ν'),  d the distance of x and y, ρ the radius of the light's surface: of the black sphere, or
//!               of the ball, through which an environment and a distant light shine
//! ```
//!
//! ν and ν' are the probabilities of the null collisions of the last segment and of that between x and y. Densities
//! of directions leave them out (ν = 1); where transmittances are exact, `ν = T`. The last density follows from
//! `f/p = a p p G/p_e T̂`: light leaves by Lambert's law with density `cos θ/(4π²ρ²)`, phase functions are 1/4π,
//! and `G = 1/d²`. A connection needs both x and y. A camera has no scattering before the first one. The place of a
//! mean intensity counts as a scattering of weight 1. An unscattered path can only hit, and its weight is 1.
//!
//! A vertex of the light is the first real collision y of a particle that sets out from its surface; y is connected to
//! the scatterings x of the walk by ratio tracking.

use super::connect::{Seeker, aim, meets_light, share};
use super::emission;
use super::sharing::{Link, SharedTechniques, Subpaths, WalkEvents};
use crate::space::connection;
use crate::space::segment::SampledMedium;
use crate::space::shadow::{Aim, LitLanes, ShadowRays, VisibleLight};
use crate::space::tally::{CollisionTally, Departure, Scattering, Tally};
use media::Majorants;
use media::sampling::MajorantView;
use numeric::geometry::exit::{self, dot, rows};
use numeric::geometry::{Bounds, Point, Ray};
use numeric::rng::Random;
use numeric::{Kept, Lane, Mask, kept};
use theory::ParticleRule;
use theory::problems::Sphere;
use theory::problems::ball::{self, Sought};
use theory::single::Tracking;
use theory::space::sphere::Techniques;

kept! {
    /// Light that walks have found, and densities of further techniques.
    pub struct Vertices<L> {
        light: L,
        /// q at the last scattering, or at the place of a sought mean intensity.
        share: L,
        /// The probability of the null collisions since that scattering.
        probability: L,
        /// The probability without the last collision, which may turn out to be real.
        before: L,
        /// The density of a connection of the last scattering with the one before.
        linked: L,
        /// Lanes with a scattering, and its place.
        is_scattered: L::Mask,
        place: [L; 3],
        /// Lanes with a particle from the light, and those in which it came to a real collision.
        has_emitted: L::Mask,
        is_emitted: L::Mask,
        /// The place of that collision, and the density of a shadow ray from it.
        first: [L; 3],
        lit: L,
    }
}

/// A walk with techniques that share its vertices. Packs make no connections, and then keep fewer numbers.
pub struct Combined<'a, B, const CONNECTS: bool> {
    seeker: Seeker<'a>,
    ground: MajorantView<'a>,
    rule: ParticleRule,
    sharing: SharedTechniques,
    tracking: Option<Tracking>,
    steps: B,
}

impl<'a, B: WalkEvents, const CONNECTS: bool> Combined<'a, B, CONNECTS> {
    /// The walk of a particle by a rule through a ball and σ̂.
    pub fn new(
        (sphere, majorants): (&'a Sphere, &'a Majorants),
        rule: ParticleRule,
        (sharing, steps): (SharedTechniques, B),
    ) -> Self {
        Self {
            seeker: Seeker { sphere },
            ground: MajorantView::new(majorants, None),
            rule,
            sharing,
            tracking: sharing.tracking(rule, majorants),
            steps,
        }
    }

    fn sphere(&self) -> &'a Sphere {
        self.seeker.sphere
    }

    fn tracker(&self) -> SampledMedium<'_> {
        SampledMedium { scene: &self.sphere().scene, ground: &self.ground }
    }

    /// True if densities include the probabilities of null collisions.
    fn has_nulls(&self) -> bool {
        self.sharing.is_full() && self.sharing.shadow.is_none()
    }

    /// The weight of a technique, given the density of shadow rays and that of connections.
    #[inline(always)]
    fn weight<L: Lane>(&self, own: usize, lit: L, connected: L) -> L {
        let Some((_, heuristic)) = self.sharing.weights() else { return lit.each(1.0) };
        let is_distant = matches!(self.sphere().light, ball::BallLight::Distant(_));
        let hit = lit.each(if is_distant { 0.0 } else { 1.0 });
        if CONNECTS {
            return self.steps.weight(heuristic, own, [hit, lit, connected]);
        }
        self.steps.weight(heuristic, own, [hit, lit])
    }

    /// `4 d²/(a ρ²)`, given d² and the place where light was scattered first.
    #[inline(always)]
    fn apart<L: Lane>(&self, square: L, first: [L; 3], which: L::Mask) -> L {
        let radius = emission::radius(self.sphere());
        // Coinciding points share nothing; a positive number avoids 0/0.
        let square = square.or_more(square.each(1e-200));
        square * 4.0 / (self.tracker().albedo(first, which) * radius * radius)
    }

    /// Scores shadow rays through transmittances, with the probabilities of their null collisions.
    #[inline(always)]
    fn add_lit<L: Lane>(
        &self,
        totals: &mut Vertices<L>,
        (which, light): LitLanes<L>,
        [through, probability]: [L; 2],
    ) {
        let one = light.each(1.0);
        let lit = one / (totals.share * if self.sharing.is_full() { probability } else { one });
        let score = self.steps.lit(light, through) * self.weight(1, lit, totals.linked);
        totals.light.add_where(which, score);
    }

    /// The exact transmittances of last segments.
    #[inline(always)]
    fn exact<L: Lane>(&self, from: [L; 3], at: &Departure<L>, which: L::Mask) -> L {
        let ([a, b, c], [x, y, z], ends) = (rows(from), rows(at.direction), rows(at.place));
        let (volume, bits) = (&*self.sphere().scene.volume, which.bits());
        at.weight.replaced(|elements| {
            for (lane, element) in elements.iter_mut().enumerate() {
                let origin = Point([a[lane], b[lane], c[lane]]);
                let direction = Point([x[lane], y[lane], z[lane]]);
                let length = (Point(ends.map(|row| row[lane])) - origin).norm();
                let ray = Ray { origin, direction, length };
                let is_asked = bits >> lane & 1 == 1;
                let exact = || connection::exact(volume, &ray, volume.bounds().clip(&ray));
                *element = if is_asked { exact() } else { 1.0 };
            }
        })
    }

    /// Starts particles from the light in the lanes of `which`; returns the number of lookups.
    #[inline(always)]
    fn emit<L: Lane>(
        &self,
        totals: &mut Vertices<L>,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> L {
        let (sphere, one) = (self.sphere(), totals.light.each(1.0));
        let cosine = |number| self.steps.cosine(number);
        let rays = emission::rays(sphere, cosine, (one, which), random);
        let flown = self.tracker().delta(rays, which, random);
        let lit = one / (share(sphere, flown.place) * self.steps.probability(flown.probability));
        totals.has_emitted |= which;
        totals.is_emitted.set_where(which, flown.collided);
        totals.first.set_where(which, flown.place);
        totals.lit.set_where(which, lit);
        flown.lookups
    }
}

impl<B: WalkEvents, const CONNECTS: bool> Tally for Combined<'_, B, CONNECTS> {
    type Found<L: Lane> = Vertices<L>;

    const CASTS: bool = true;

    const CONNECTS: bool = CONNECTS;

    #[inline(always)]
    fn nothing<L: Lane>(&self, zero: L) -> Vertices<L> {
        let (none, one) = (zero.below(zero), zero.each(1.0));
        Vertices {
            light: zero,
            share: one,
            probability: one,
            before: one,
            linked: zero,
            is_scattered: none,
            place: [zero; 3],
            has_emitted: none,
            is_emitted: none,
            first: [zero; 3],
            lit: zero,
        }
    }

    #[inline(always)]
    fn value<L: Lane>(&self, totals: &Vertices<L>, _: usize) -> L {
        totals.light
    }

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> [[L; 3]; 2] {
        self.seeker.begin(one, which, random)
    }

    fn begins_turned(&self) -> bool {
        self.seeker.begins_turned()
    }

    #[inline(always)]
    fn collided<L: Lane>(&self, totals: &mut Vertices<L>, at: &CollisionTally<L>) {
        if self.has_nulls() {
            let probability =
                self.steps.probability(self.rule.probabilities(at.ratio, at.albedo).transmit);
            if CONNECTS {
                totals.before.set_where(at.inside, totals.probability);
            }
            totals.probability.scale_where(at.inside, probability);
        }
    }

    #[inline(always)]
    fn scattered<L: Lane>(&self, totals: &mut Vertices<L>, which: L::Mask, place: [L; 3]) {
        if !which.maybe() || self.sharing.techniques == Techniques::NextEvent {
            return;
        }
        if CONNECTS {
            let [a, b, c] = totals.place;
            let away = [place[0] - a, place[1] - b, place[2] - c];
            let square = dot(away, away);
            let linked = self.apart(square, place, which) / totals.before;
            let is_linked = self.sharing.subpaths.is_some();
            totals.linked.set_where(which, square.each(0.0));
            if is_linked {
                let linked = self.steps.linked(linked, square);
                totals.linked.set_where(which & totals.is_scattered, linked);
            }
            totals.is_scattered |= which;
            totals.place.set_where(which, place);
        }
        totals.share.set_where(which, share(self.sphere(), place));
        totals.probability.set_where(which, self.steps.segment(totals.probability));
    }

    /// Light that was never scattered can only be hit.
    #[inline(always)]
    fn escaped<L: Lane>(&self, totals: &mut Vertices<L>, at: &Departure<L>) {
        let (extinctions, one) = (meets_light(self.sphere(), at), at.weight.each(1.0));
        if !extinctions.maybe() {
            return;
        }
        let is_ray = self.sphere().sought == Sought::Radiance;
        let unscattered = if is_ray { at.unscattered } else { at.left & !at.left };
        if self.sharing.techniques == Techniques::NextEvent {
            return totals.light.add_where(extinctions & self.steps.counts(unscattered), at.weight);
        }
        let probability = match self.sharing.shadow {
            _ if !self.sharing.is_full() => one,
            Some(_) if CONNECTS => self.exact(totals.place, at, extinctions & totals.is_scattered),
            _ => totals.probability,
        };
        let mut weight = self.weight(0, one / (totals.share * probability), totals.linked);
        weight.set_where(unscattered, one.each(self.steps.unscattered()));
        totals.light.add_where(extinctions, at.weight * weight);
    }

    fn core(&self) -> Option<(Point, f64)> {
        self.seeker.core()
    }

    fn shadow_rays(&self) -> Option<ShadowRays<'_>> {
        let Sphere { centre, radius, .. } = *self.sphere();
        let volume = &*self.sphere().scene.volume;
        let bounds = Bounds::Sphere { centre, radius };
        self.tracking.map(|tracking| ShadowRays::new(volume, bounds, tracking))
    }

    fn parallel(&self) -> Option<Point> {
        match self.sphere().light {
            ball::BallLight::Distant(direction) => Some(direction),
            ball::BallLight::Environment | ball::BallLight::BlackSphere(_) => None,
        }
    }

    #[inline(always)]
    fn aim<L: Lane>(&self, place: [L; 3], number: L) -> Aim<L> {
        let sphere = self.sphere();
        number.outlined_if_narrow(
            #[inline(always)]
            move || aim(sphere, place, number),
        )
    }

    #[inline(always)]
    fn light<L: Lane>(&self, place: [L; 3], aimed: VisibleLight<L>) -> VisibleLight<L> {
        self.steps.light(self.sphere(), place, aimed)
    }

    #[inline(always)]
    fn lit<L: Lane>(&self, totals: &mut Vertices<L>, light: LitLanes<L>, through: L) {
        self.add_lit(totals, light, [through, through]);
    }

    /// Tracks shadow rays by ratio tracking through the σ̂ of the walk.
    #[inline(always)]
    fn track<L: Lane>(
        &self,
        totals: &mut Vertices<L>,
        at: &Scattering<L>,
        (light, [from, to]): (&VisibleLight<L>, [L; 2]),
        random: &mut impl Random<L>,
    ) -> L {
        let (from, end) = (from.or_more(to.each(0.0)), light.distance.or_less(to));
        let is_blocked = at.which & from.below(end);
        let rays = [at.place, light.direction];
        let segment = self.tracker().ratio(rays, (is_blocked, end), self.rule, random);
        let through = segment.transmittance;
        let light = (at.which, at.weight * light.share * through);
        self.add_lit(totals, light, [through, segment.probability]);
        segment.lookups
    }

    /// Connects scatterings with vertices of the light.
    #[inline(always)]
    fn connect<L: Lane>(
        &self,
        totals: &mut Vertices<L>,
        at: &Scattering<L>,
        random: &mut impl Random<L>,
    ) -> L {
        let (zero, sphere) = (at.weight.each(0.0), self.sphere());
        let Some(subpaths) = self.sharing.subpaths else { return zero };
        if !at.which.any() {
            return zero;
        }
        let is_shared = subpaths == Subpaths::Shared;
        let emits = if is_shared { at.which & !totals.has_emitted } else { at.which };
        let lookups = self.emit(totals, emits, random);
        let ([x, y, z], [a, b, c]) = (totals.first, at.place);
        let away = [x - a, y - b, z - c];
        let distance = dot(away, away).root();
        let (direction, is_apart) = normalised(away);
        let mut which = at.which & totals.is_emitted & is_apart;
        if let ball::BallLight::BlackSphere(core) = sphere.light {
            let (misses, near) = exit::meets(sphere.centre, core, at.place, direction);
            which &= !self.steps.is_hidden(!misses & near.below(distance));
        }
        let rays = [at.place, direction];
        let segment = self.tracker().ratio(rays, (which, distance), self.rule, random);
        let transmittance = segment.transmittance;
        let apart = self.apart(distance * distance, totals.first, which);
        let albedo = self.tracker().albedo(totals.first, which);
        let link = Link { distance, albedo, transmittance };
        let score = self.steps.connected(at.weight * transmittance / apart, &link);
        let weight = self.weight(2, totals.lit, apart / segment.probability);
        totals.light.add_where(which & !transmittance.equals(0.0), score * weight);
        lookups + segment.lookups
    }
}

/// Unit vectors in the same directions, and the lanes that have one: [`Point::normalised`] for lanes.
#[inline(always)]
fn normalised<L: Lane>([x, y, z]: [L; 3]) -> ([L; 3], L::Mask) {
    let zero = x.each(0.0);
    let largest = zero.or_more(x.size()).or_more(y.size()).or_more(z.size());
    let scale = largest.each(1.0) / largest;
    let [x, y, z] = [x * scale, y * scale, z * scale];
    let factor = scale.each(1.0) / dot([x, y, z], [x, y, z]).root();
    let is_vector = zero.below(largest) & largest.below(zero.each(f64::INFINITY));
    ([x * factor, y * factor, z * factor], is_vector)
}

//! Walks from an eye to its light by packets: what they begin with, and what they find.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::draw_by`], or [`Page::draw`], makes from stream
//! j mod 16.

use fearless_simd::{ExtractToken, Level, Simd, f64x8, mask64x8};

use super::Page;
use super::combined::Sharing;
use super::connect::{UP, aim, cone};
use crate::Setup;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::Numbers;
use crate::space::exit::{Points, dot, splat};
use crate::space::packet::walks;
use crate::space::shadow::{Aim, Found, ShadowRays};
use crate::space::tally::{Collision, Departure, add_where};
use crate::space::{Particle, Tally};
use numeric::geometry::{Bounds, Point};
use numeric::{Lane, pack};
use theory::lit_rod::Densities;
use theory::problems::Sphere;
use theory::problems::sphere::{self, Sought};
use theory::single::Tracking;
use theory::{Heuristic, ParticleRule};

/// Whether particles that have left have met the light.
#[inline(always)]
fn meets_light<L: Lane>(sphere: &Sphere, at: &Departure<L>) -> L::Mask {
    match sphere.light {
        sphere::Light::Environment => at.left,
        sphere::Light::Distant(_) => at.left & !at.left,
        sphere::Light::BlackSphere(core) => {
            let middle = 0.5 * (core + sphere.radius);
            let distance = sphere.centre.square_to(at.place, 1.0).root();
            at.left & distance.below(distance.each(middle))
        }
    }
}

/// [`aim`], in a function of its own on AVX2.
#[inline(always)]
fn aimed<S: Simd>(sphere: &Sphere, place: Points<S>, number: f64x8<S>) -> Aim<f64x8<S>> {
    pack::outlined_if_narrow(
        number.token(),
        #[inline(always)]
        move || aim(sphere, place, number),
    )
}

/// Walks that look for light, with shadow rays or without.
struct Seekers<'a, const CASTS: bool> {
    sphere: &'a Sphere,
    shadow: Tracking,
}

impl<const CASTS: bool> Tally<1> for Seekers<'_, CASTS> {
    const CASTS: bool = CASTS;

    /// Where the direction may be any, they turn from here.
    #[inline(always)]
    fn begin<S: Simd>(&self, simd: S, _: &mut Numbers<S>, _: mask64x8<S>) -> [Points<S>; 2] {
        let direction = match self.sphere.sought {
            Sought::Radiance => self.sphere.direction(),
            Sought::MeanIntensity => UP,
        };
        [splat(simd, self.sphere.entry()), splat(simd, direction)]
    }

    fn begins_turned(&self) -> bool {
        self.sphere.sought == Sought::MeanIntensity
    }

    /// Beside shadow rays only what was never scattered counts, and that of rays only.
    #[inline(always)]
    fn escaped<L: Lane>(&self, [found]: &mut [L; 1], at: &Departure<L>) {
        let met = meets_light(self.sphere, at);
        if !CASTS {
            add_where(found, met, at.weight);
        } else if self.sphere.sought == Sought::Radiance {
            add_where(found, met & at.unscattered, at.weight);
        }
    }

    fn core(&self) -> Option<(Point, f64)> {
        super::core(self.sphere)
    }

    fn shadow_rays(&self) -> Option<ShadowRays<'_>> {
        let Sphere { centre, radius, .. } = *self.sphere;
        let volume = &*self.sphere.scene.volume;
        let bounds = Bounds::Sphere { centre, radius };
        CASTS.then(|| ShadowRays::new(volume, bounds, self.shadow))
    }

    fn parallel(&self) -> Option<Point> {
        match self.sphere.light {
            sphere::Light::Distant(direction) => Some(direction),
            sphere::Light::Environment | sphere::Light::BlackSphere(_) => None,
        }
    }

    #[inline(always)]
    fn aim<S: Simd>(&self, place: Points<S>, number: f64x8<S>) -> Aim<f64x8<S>> {
        aimed(self.sphere, place, number)
    }

    #[inline(always)]
    fn lit<S: Simd>(&self, [found]: &mut [f64x8<S>; 1], (which, light): Found<S>, _: f64x8<S>) {
        add_where(found, which, light);
    }

    fn channels(&self) -> &[usize] {
        &[0]
    }
}

/// Walks whose hits and shadow rays share what they find: the light, q where a walk was scattered last, and the chance
/// of the null collisions since.
struct Sharers<'a> {
    seekers: Seekers<'a, true>,
    rule: ParticleRule,
    densities: Densities,
    heuristic: Heuristic,
}

impl Sharers<'_> {
    /// The densities of a hit and of a shadow ray.
    #[inline(always)]
    fn densities<L: Lane>(&self, share: L, chance: L) -> [L; 2] {
        let is_full = self.densities == Densities::Full;
        let chance = if is_full { chance } else { chance.each(1.0) };
        let is_distant = matches!(self.seekers.sphere.light, sphere::Light::Distant(_));
        let hit = share.each(if is_distant { 0.0 } else { 1.0 });
        [hit, share.each(1.0) / (share * chance)]
    }
}

impl Tally<3> for Sharers<'_> {
    const CASTS: bool = true;

    #[inline(always)]
    fn begin<S: Simd>(
        &self,
        simd: S,
        numbers: &mut Numbers<S>,
        which: mask64x8<S>,
    ) -> [Points<S>; 2] {
        self.seekers.begin(simd, numbers, which)
    }

    fn begins_turned(&self) -> bool {
        self.seekers.begins_turned()
    }

    #[inline(always)]
    fn collided<L: Lane>(&self, [_, _, chance]: &mut [L; 3], at: &Collision<L>) {
        if self.densities == Densities::Full {
            let passed = *chance * self.rule.odds(at.ratio, at.albedo).transmit;
            *chance = L::select(at.inside, passed, *chance);
        }
    }

    #[inline(always)]
    fn scattered<L: Lane>(
        &self,
        [_, share, chance]: &mut [L; 3],
        which: L::Mask,
        [x, y, z]: [L; 3],
    ) {
        let (Sphere { centre: Point([a, b, c]), light, .. }, one) =
            (self.seekers.sphere, x.each(1.0));
        let seen = match *light {
            sphere::Light::BlackSphere(core) => {
                let [x, y, z] = [one.each(*a) - x, one.each(*b) - y, one.each(*c) - z];
                cone(core, dot([x, y, z], [x, y, z]).root()) * 0.5
            }
            sphere::Light::Environment | sphere::Light::Distant(_) => one,
        };
        *share = L::select(which, seen, *share);
        *chance = L::select(which, one, *chance);
    }

    /// What was never scattered can be hit only.
    #[inline(always)]
    fn escaped<L: Lane>(&self, [found, share, chance]: &mut [L; 3], at: &Departure<L>) {
        let one = at.weight.each(1.0);
        let weight = self.heuristic.weight(0, self.densities(*share, *chance));
        let weight = match self.seekers.sphere.sought {
            Sought::Radiance => L::select(at.unscattered, one, weight),
            Sought::MeanIntensity => weight,
        };
        add_where(found, meets_light(self.seekers.sphere, at), at.weight * weight);
    }

    fn core(&self) -> Option<(Point, f64)> {
        self.seekers.core()
    }

    fn shadow_rays(&self) -> Option<ShadowRays<'_>> {
        self.seekers.shadow_rays()
    }

    fn parallel(&self) -> Option<Point> {
        self.seekers.parallel()
    }

    #[inline(always)]
    fn aim<S: Simd>(&self, place: Points<S>, number: f64x8<S>) -> Aim<f64x8<S>> {
        self.seekers.aim(place, number)
    }

    #[inline(always)]
    fn lit<S: Simd>(
        &self,
        [found, share, _]: &mut [f64x8<S>; 3],
        (which, light): Found<S>,
        through: f64x8<S>,
    ) {
        let weight = self.heuristic.weight(1, self.densities(*share, through));
        add_where(found, which, light * weight);
    }

    fn channels(&self) -> &[usize] {
        &[0]
    }
}

/// Makes draws by packets that share what hits and shadow rays of some tracking find.
pub(super) fn share_by_packets<'a>(
    level: Level,
    page: &Page,
    shadow: Tracking,
    setup: &Setup<Sphere>,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let sphere = &*setup.problem;
    let Sharing { densities, heuristic, .. } = page.sharing;
    let (seekers, rule) = (Seekers { sphere, shadow }, page.particle.rule);
    let sharers = Sharers { seekers, rule, densities, heuristic };
    walks(level, &sharers, &page.particle, (&sphere.scene, setup.space.as_ref()), request)
}

/// Makes draws by packets, without shadow rays or with them.
pub(super) fn draw_by_packets<'a>(
    level: Level,
    particle: &Particle,
    shadow: Option<Tracking>,
    setup: &Setup<Sphere>,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let sphere = &*setup.problem;
    let world = (&sphere.scene, setup.space.as_ref());
    match shadow {
        None => {
            let seekers = Seekers::<false> { sphere, shadow: Tracking::Exact };
            walks(level, &seekers, particle, world, request)
        }
        Some(shadow) => walks(level, &Seekers::<true> { sphere, shadow }, particle, world, request),
    }
}

//! Walks from an eye to its light by packets: what they begin with, and what they find.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::draw_by`] makes from stream j mod 16.

use fearless_simd::{Level, Simd, f64x8, mask64x8};

use super::connect::{UP, light};
use crate::estimators::Setup;
use crate::estimators::space::exit::{Points, splat};
use crate::estimators::space::packet::walks;
use crate::estimators::space::shadow::{Found, Light, ShadowRays};
use crate::estimators::space::tally::{Departure, add_where};
use crate::estimators::space::{Particle, Tally};
use crate::geometry::{Bounds, Point};
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::Numbers;
use crate::numeric::Lane;
use crate::problems::Sphere;
use crate::problems::sphere::{self, Sought};
use crate::theory::single::Tracking;

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
        CASTS.then_some(ShadowRays { volume, bounds, tracking: self.shadow })
    }

    #[inline(always)]
    fn light<S: Simd>(
        &self,
        numbers: &mut Numbers<S>,
        which: mask64x8<S>,
        place: Points<S>,
    ) -> Light<f64x8<S>> {
        light(
            self.sphere,
            place,
            #[inline(always)]
            || numbers.uniform_where(which),
        )
    }

    #[inline(always)]
    fn lit<S: Simd>(&self, [found]: &mut [f64x8<S>; 1], (which, light): Found<S>) {
        add_where(found, which, light);
    }

    fn channels(&self) -> &[usize] {
        &[0]
    }
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

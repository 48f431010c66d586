//! Walks from an eye to its light by packets: what they begin with, and what they find.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::draw_by`] makes from stream j mod 16.

use fearless_simd::{Level, Simd, f64x8, mask64x8};

use super::connect::cone;
use crate::estimators::Setup;
use crate::estimators::packet::Request;
use crate::estimators::packet::bank::Numbers;
use crate::estimators::space::exit::{Points, dot, meets, splat};
use crate::estimators::space::packet::walks;
use crate::estimators::space::shadow::{self, Found, ShadowRays};
use crate::estimators::space::tally::{Departure, add_where};
use crate::estimators::space::{Particle, Tally};
use crate::geometry::{Point, frame};
use crate::numeric::Lane;
use crate::problems::Sphere;
use crate::problems::sphere::{Light, Sought};
use crate::theory::single::Tracking;

/// Upwards: a direction from which any other is found by an even cosine and an even azimuth.
const UP: Point = Point([0.0, 0.0, 1.0]);

/// A direction of all alike, for those that a mask names.
#[inline(always)]
fn anywhere<S: Simd>(numbers: &mut Numbers<S>, which: mask64x8<S>, up: Points<S>) -> Points<S> {
    let cosine = numbers.uniform_where(which) * 2.0 - 1.0;
    frame::turned_lanes(up, cosine, numbers.uniform_where(which))
}

/// Whether particles that have left have met the light.
#[inline(always)]
fn meets_light<L: Lane>(sphere: &Sphere, at: &Departure<L>) -> L::Mask {
    match sphere.light {
        Light::Environment => at.left,
        Light::Distant(_) => at.left & !at.left,
        Light::BlackSphere(core) => {
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
        CASTS.then_some(ShadowRays { volume, centre, radius, tracking: self.shadow })
    }

    #[inline(always)]
    fn light<S: Simd>(
        &self,
        numbers: &mut Numbers<S>,
        which: mask64x8<S>,
        place: Points<S>,
    ) -> shadow::Light<S> {
        let one = place[0].each(1.0);
        let zero = one.each(0.0);
        let endless = one.each(f64::INFINITY);
        match self.sphere.light {
            Light::Environment => {
                let direction = anywhere(numbers, which, [zero, zero, one]);
                shadow::Light { direction, share: one, distance: endless }
            }
            Light::Distant(Point(direction)) => {
                let [x, y, z] = direction;
                let direction = [one.each(x), one.each(y), one.each(z)];
                shadow::Light { direction, share: one, distance: endless }
            }
            Light::BlackSphere(core) => {
                let centre = self.sphere.centre;
                let [a, b, c] = centre.0;
                let [x, y, z] = place;
                let to_centre = [one.each(a) - x, one.each(b) - y, one.each(c) - z];
                let distance = dot(to_centre, to_centre).root();
                let cone = cone(core, distance);
                let cosine = one - numbers.uniform_where(which) * cone;
                let scale = one / distance;
                let [x, y, z] = to_centre;
                let axis = [x * scale, y * scale, z * scale];
                let direction = frame::turned_lanes(axis, cosine, numbers.uniform_where(which));
                let (misses, near) = meets(centre, core, place, direction);
                // A direction at the edge may miss by rounding: it ends at the point of the edge.
                let light = Lane::select(misses, distance * cosine, near);
                shadow::Light { direction, share: cone * 0.5, distance: light }
            }
        }
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
    let Some(majorants) = setup.space.as_deref() else { return Some(request) };
    let sphere = &*setup.problem;
    let world = (&sphere.scene, majorants);
    match shadow {
        None => {
            let seekers = Seekers::<false> { sphere, shadow: Tracking::Exact };
            walks(level, &seekers, particle, world, request)
        }
        Some(shadow) => walks(level, &Seekers::<true> { sphere, shadow }, particle, world, request),
    }
}

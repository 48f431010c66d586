//! Shadow rays from scatterings to the light of a ball, and what a walk finds by itself.
//!
//! ```text
//! at a scattering of weight w, the albedo in it:   X += w Ω/4π T̂
//! environment       a direction of any odds alike, Ω = 4π, T̂ to the surface
//! black sphere      a direction in its cone, Ω = 2π(1 − √(1 − ρ²/r²)), T̂ to where it meets the sphere
//! distant light     its direction, irradiance 4π, T̂ to the surface
//! ```
//!
//! Where there are shadow rays, light that a walk meets after a scattering is theirs and is not counted
//! again; met before the first one, it is. A point whose mean intensity is sought is a first scattering of
//! weight 1. A shadow ray of weight 0 is not cast, and one that leaves the ball at once costs nothing.

use super::core;
use crate::single_scattering::connection;
use crate::space::shadow;
use crate::space::{Scattering, Sink, exit};
use numeric::geometry::{Point, Ray, frame};
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::problems::Sphere;
use theory::problems::sphere::{Light, Sought};
use theory::single::Tracking;

/// The steps of next-event estimation that a known bug may replace.
pub trait Connect: Sync {
    /// The weight of a shadow ray.
    fn weight(&self, sphere: &Sphere, at: &Scattering) -> f64 {
        let _ = sphere;
        at.weight
    }

    /// `Ω/4π` of a black sphere of radius ρ, seen from a distance r.
    fn share(&self, core: f64, distance: f64) -> f64 {
        0.5 * cone(core, distance)
    }

    /// The stretch of a shadow ray: within the ball, up to the light.
    fn reach(&self, within: Span, light: f64) -> Span {
        Span::new(within.from, light.min(within.to))
    }

    /// Whether light that a walk meets after so many scatterings counts.
    fn counts(&self, order: u32) -> bool {
        order == 0
    }
}

/// Next-event estimation as it should be.
#[derive(Debug, Clone, Copy)]
pub struct Honest;

impl Connect for Honest {}

/// `1 − √(1 − ρ²/r²)`, without cancellation.
#[inline(always)]
pub fn cone<L: Lane>(core: f64, distance: L) -> L {
    let (zero, one) = (distance.each(0.0), distance.each(1.0));
    let square = distance.each(core * core) / (distance * distance);
    square / (one + (one - square).or_more(zero).root())
}

/// How far it is to a sphere, for what comes from outside and meets it.
#[inline(always)]
pub fn meets(origin: Point, direction: Point, centre: Point, radius: f64) -> Option<f64> {
    let (misses, near) = exit::meets(centre, radius, origin.0, direction.0);
    (!misses).then_some(near)
}

/// Upwards: a direction from which any other is found by an even cosine and an even azimuth.
pub const UP: Point = Point([0.0, 0.0, 1.0]);

/// A point in all lanes.
#[inline(always)]
fn lanes<L: Lane>(like: L, Point([x, y, z]): Point) -> [L; 3] {
    [like.each(x), like.each(y), like.each(z)]
}

/// How a shadow ray from a place is aimed at the light by a uniform number; a distant one needs none.
#[inline(always)]
pub fn aim<L: Lane>(sphere: &Sphere, place: [L; 3], number: L) -> shadow::Aim<L> {
    let one = place[0].each(1.0);
    match sphere.light {
        Light::Environment => {
            let (axis, distance) = (lanes(one, UP), one.each(f64::INFINITY));
            shadow::Aim { axis, cosine: number * 2.0 - 1.0, share: one, distance }
        }
        Light::Distant(direction) => {
            let (axis, distance) = (lanes(one, direction), one.each(f64::INFINITY));
            shadow::Aim { axis, cosine: one, share: one, distance }
        }
        Light::BlackSphere(core) => {
            let ([a, b, c], [x, y, z]) = (lanes(one, sphere.centre), place);
            let [x, y, z] = [a - x, b - y, c - z];
            let distance = exit::dot([x, y, z], [x, y, z]).root();
            let cone = cone(core, distance);
            let (cosine, scale) = (one - number * cone, one / distance);
            let axis = [x * scale, y * scale, z * scale];
            shadow::Aim { axis, cosine, share: cone * 0.5, distance }
        }
    }
}

/// Where a shadow ray from a place is cast to, by uniform numbers.
fn light(sphere: &Sphere, place: Point, rng: &mut Stream) -> shadow::Light<f64> {
    if let Light::Distant(Point(direction)) = sphere.light {
        return shadow::Light { direction, share: 1.0, distance: f64::INFINITY };
    }
    let aim = aim(sphere, place.0, rng.uniform());
    let direction = frame::turned_lanes(aim.axis, aim.cosine, rng.uniform());
    let stop = core(sphere).map(|(centre, radius)| exit::meets(centre, radius, place.0, direction));
    aim.light(direction, stop)
}

/// A shadow ray.
#[derive(Debug, Clone, Copy)]
pub struct ShadowRay {
    /// What its light is worth without a medium.
    pub share: f64,
    /// From where, and where to.
    pub ray: Ray,
    /// Where on it the medium is.
    pub inside: Span,
}

impl ShadowRay {
    /// From a place to a light that is chosen by uniform numbers.
    pub fn cast(sphere: &Sphere, connect: &dyn Connect, place: Point, rng: &mut Stream) -> Self {
        let shadow::Light { direction, mut share, distance } = light(sphere, place, rng);
        if let Light::BlackSphere(core) = sphere.light {
            share = connect.share(core, (sphere.centre - place).norm());
        }
        let ray = Ray { origin: place, direction: Point(direction), length: f64::INFINITY };
        let within = sphere.scene.volume.bounds().clip(&ray);
        Self { share, ray, inside: connect.reach(within, distance) }
    }

    /// What comes through the medium, and the lookups that it takes to know.
    pub fn transmittance(&self, sphere: &Sphere, shadow: Tracking, rng: &mut Stream) -> (f64, u32) {
        if self.inside.is_empty() {
            return (1.0, 0);
        }
        connection::transmittance(&*sphere.scene.volume, &self.ray, self.inside, shadow, rng)
    }
}

/// Whether a walk that left at a place has met the light.
pub fn is_met(sphere: &Sphere, at: Point) -> bool {
    match sphere.light {
        Light::Environment => true,
        Light::Distant(_) => false,
        Light::BlackSphere(core) => {
            let middle = 0.5 * (core + sphere.radius);
            (at - sphere.centre).norm() < middle
        }
    }
}

/// What finds light along a walk.
pub trait Finder: Sink {
    /// The walk begins: at a place whose mean intensity is sought, in a direction of any odds alike, or else along a
    /// ray. Answers how many lookups it took what is estimated from there.
    fn begin(&mut self, sought: Option<Point>, rng: &mut Stream) -> u32;

    /// What it has found.
    fn found(&self) -> f64;
}

/// A walk that looks for light.
pub struct Seeker<'a> {
    sphere: &'a Sphere,
    connect: Option<(&'a dyn Connect, Tracking)>,
    found: f64,
}

impl<'a> Seeker<'a> {
    /// With shadow rays, or without.
    pub fn new(sphere: &'a Sphere, connect: Option<(&'a dyn Connect, Tracking)>) -> Self {
        Self { sphere, connect, found: 0.0 }
    }

    /// Casts a shadow ray from a place with a weight.
    fn cast(
        &mut self,
        connect: &dyn Connect,
        shadow: Tracking,
        (place, weight): (Point, f64),
        rng: &mut Stream,
    ) -> u32 {
        if weight == 0.0 {
            return 0;
        }
        let ray = ShadowRay::cast(self.sphere, connect, place, rng);
        let (through, lookups) = ray.transmittance(self.sphere, shadow, rng);
        self.found += weight * ray.share * through;
        lookups
    }
}

impl Finder for Seeker<'_> {
    fn begin(&mut self, sought: Option<Point>, rng: &mut Stream) -> u32 {
        let (Some(place), Some((connect, shadow))) = (sought, self.connect) else { return 0 };
        self.cast(connect, shadow, (place, 1.0), rng)
    }

    fn found(&self) -> f64 {
        self.found
    }
}

impl Sink for Seeker<'_> {
    fn scattered(&mut self, at: &Scattering, rng: &mut Stream) -> u32 {
        let Some((connect, shadow)) = self.connect else { return 0 };
        let weight = connect.weight(self.sphere, at);
        self.cast(connect, shadow, (at.place, weight), rng)
    }

    fn escaped(&mut self, at: Point, _: Point, weight: f64, order: u32) {
        let counts = match self.connect {
            None => true,
            Some((connect, _)) => {
                let is_point = self.sphere.sought == Sought::MeanIntensity;
                connect.counts(order + u32::from(is_point))
            }
        };
        if counts && is_met(self.sphere, at) {
            self.found += weight;
        }
    }
}

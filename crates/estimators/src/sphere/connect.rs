//! Shadow rays from scatterings to the light of a ball, and hits of the light by walks.
//!
//! ```text
//! at a scattering of weight w, the albedo in it:   X += w Ω/4π T̂
//! environment       a uniform direction, Ω = 4π, T̂ to the surface
//! black sphere      a direction in its cone, Ω = 2π(1 − √(1 − ρ²/r²)), T̂ to where it meets the sphere
//! distant light     its direction, irradiance 4π, T̂ to the surface
//! ```
//!
//! Where there are shadow rays, light that a walk hits after a scattering is not counted: shadow rays count it.
//! Light that is hit before the first scattering is counted. The point of a mean intensity is a first scattering of
//! weight 1. A shadow ray of weight 0 is not cast, and one that leaves the ball at once costs nothing.

use crate::space::shadow::Aim;
use crate::space::tally::{Departure, Tally};
use numeric::Lane;
use numeric::geometry::Point;
use numeric::geometry::exit::dot;
use numeric::rng::Random;
use theory::problems::Sphere;
use theory::problems::ball::{self, Sought};

/// `1 − √(1 − ρ²/r²)`, without cancellation.
#[inline(always)]
pub fn cone<L: Lane>(core: f64, distance: L) -> L {
    let (zero, one) = (distance.each(0.0), distance.each(1.0));
    let square = distance.each(core * core) / (distance * distance);
    square / (one + (one - square).or_more(zero).root())
}

/// Upwards: the axis of directions with a uniform cosine and a uniform azimuth.
pub const UP: Point = Point([0.0, 0.0, 1.0]);

/// The vectors from places to the centre of a ball, and their lengths.
#[inline(always)]
fn to_centre<L: Lane>(sphere: &Sphere, [x, y, z]: [L; 3]) -> ([L; 3], L) {
    let [a, b, c] = sphere.centre.each(x);
    let away = [a - x, b - y, c - z];
    (away, dot(away, away).root())
}

/// The aim of shadow rays from places at the light, from uniform numbers; a distant light needs none.
#[inline(always)]
pub fn aim<L: Lane>(sphere: &Sphere, place: [L; 3], number: L) -> Aim<L> {
    let one = number.each(1.0);
    match sphere.light {
        ball::BallLight::Environment => {
            let (axis, distance) = (UP.each(one), one.each(f64::INFINITY));
            Aim { axis, cosine: number * 2.0 - 1.0, share: one, distance }
        }
        ball::BallLight::Distant(direction) => {
            let (axis, distance) = (direction.each(one), one.each(f64::INFINITY));
            Aim { axis, cosine: one, share: one, distance }
        }
        ball::BallLight::BlackSphere(core) => {
            let ([x, y, z], distance) = to_centre(sphere, place);
            let cone = cone(core, distance);
            let (cosine, scale) = (one - number * cone, one / distance);
            Aim { axis: [x * scale, y * scale, z * scale], cosine, share: cone * 0.5, distance }
        }
    }
}

/// q, the solid angle of the light as seen from places, as a fraction of 4π.
#[inline(always)]
pub fn share<L: Lane>(sphere: &Sphere, place: [L; 3]) -> L {
    match sphere.light {
        ball::BallLight::BlackSphere(core) => cone(core, to_centre(sphere, place).1) * 0.5,
        ball::BallLight::Environment | ball::BallLight::Distant(_) => place[0].each(1.0),
    }
}

/// Lanes that leave in a direction with light.
#[inline(always)]
pub fn meets_light<L: Lane>(sphere: &Sphere, at: &Departure<L>) -> L::Mask {
    match sphere.light {
        ball::BallLight::Environment => at.left,
        ball::BallLight::Distant(_) => at.left & !at.left,
        ball::BallLight::BlackSphere(core) => {
            let middle = 0.5 * (core + sphere.radius);
            let distance = sphere.centre.square_to(at.place, 1.0).root();
            at.left & distance.below(distance.each(middle))
        }
    }
}

/// Walks that score when they hit the light.
pub struct Seeker<'a> {
    /// The ball.
    pub sphere: &'a Sphere,
}

impl Tally for Seeker<'_> {
    type Found<L: Lane> = [L; 1];

    #[inline(always)]
    fn nothing<L: Lane>(&self, zero: L) -> [L; 1] {
        [zero]
    }

    #[inline(always)]
    fn value<L: Lane>(&self, [light]: &[L; 1], _: usize) -> L {
        *light
    }

    /// Walks in all directions turn from this one.
    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> [[L; 3]; 2] {
        let direction = match self.sphere.sought {
            Sought::Radiance => self.sphere.direction(),
            Sought::MeanIntensity => UP,
        };
        [self.sphere.entry().each(one), direction.each(one)]
    }

    fn begins_turned(&self) -> bool {
        self.sphere.sought == Sought::MeanIntensity
    }

    #[inline(always)]
    fn escaped<L: Lane>(&self, [totals]: &mut [L; 1], at: &Departure<L>) {
        totals.add_where(meets_light(self.sphere, at), at.weight);
    }

    fn core(&self) -> Option<(Point, f64)> {
        match self.sphere.light {
            ball::BallLight::BlackSphere(radius) => Some((self.sphere.centre, radius)),
            ball::BallLight::Environment | ball::BallLight::Distant(_) => None,
        }
    }
}

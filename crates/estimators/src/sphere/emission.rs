//! Particles that set out from the light of a ball.
//!
//! ```text
//! black sphere     from a point of its surface, any as likely, outwards
//! environment      from a point of the ball's surface, any as likely, inwards
//! distant light    against its direction, through any point of the ball's disc
//! ```
//!
//! Directions obey Lambert's law about the normal, with density `cos θ/π` per steradian. The density of the first two is
//! `cos θ/(4π²ρ²)` per steradian and area, `1/(4π²ρ²)` per steradian and area across: the same for every ray that
//! leaves a surface of radius ρ. That of a distant light of irradiance 4π is `1/(πρ²)`, worth as much.

use super::connect::UP;
use numeric::geometry::{Point, Ray, frame};
use numeric::rng::Stream;
use theory::problems::Sphere;
use theory::problems::sphere::Light;

/// ρ, the radius of the surface that light comes from, or through.
pub fn radius(sphere: &Sphere) -> f64 {
    match sphere.light {
        Light::BlackSphere(core) => core,
        Light::Environment | Light::Distant(_) => sphere.radius,
    }
}

/// A particle at the light's surface; the cosine with the normal is made of a uniform number.
pub fn ray(sphere: &Sphere, cosine: impl Fn(f64) -> f64, rng: &mut Stream) -> Ray {
    // Numbers are taken in this order.
    let lambert = |axis: Point, rng: &mut Stream| {
        let cosine = cosine(rng.uniform());
        frame::turned(axis, cosine, rng.uniform())
    };
    let (normal, direction) = match sphere.light {
        // A point of the disc is the foot of one of the sphere: by Lambert's law any of them is as likely.
        Light::Distant(towards) => (lambert(towards, rng), towards * -1.0),
        light => {
            let normal = frame::turned(UP, 2.0 * rng.uniform() - 1.0, rng.uniform());
            let is_outwards = matches!(light, Light::BlackSphere(_));
            let axis = if is_outwards { normal } else { normal * -1.0 };
            (normal, lambert(axis, rng))
        }
    };
    let origin = sphere.centre + normal * radius(sphere);
    Ray { origin, direction, length: f64::INFINITY }
}

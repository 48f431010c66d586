//! Particles that start at the light of a ball.
//!
//! ```text
//! black sphere     from a point of its surface, any as likely, outwards
//! environment      from a point of the ball's surface, any as likely, inwards
//! distant light    against its direction, through any point of the ball's disc
//! ```
//!
//! Directions obey Lambert's law about the normal, with density `cos θ/π` per steradian. The density of the first
//! two is `cos θ/(4π²ρ²)` per steradian and area, `1/(4π²ρ²)` per steradian and area across: equal for every ray
//! that leaves a surface of radius ρ. That of a distant light of irradiance 4π is `1/(πρ²)`, which gives the same
//! score.

use super::connect::UP;
use numeric::Lane;
use numeric::geometry::exit::along;
use numeric::geometry::frame::turned_lanes;
use numeric::rng::Random;
use theory::problems::Sphere;
use theory::problems::ball::BallLight;

/// ρ, the radius of the surface that light comes from, or through.
pub fn radius(sphere: &Sphere) -> f64 {
    match sphere.light {
        BallLight::BlackSphere(core) => core,
        BallLight::Environment | BallLight::Distant(_) => sphere.radius,
    }
}

/// Directions about an axis by Lambert's law, for the lanes in `which`.
#[inline(always)]
fn lambert<L: Lane>(
    axis: [L; 3],
    cosine: impl Fn(L) -> L,
    which: L::Mask,
    random: &mut impl Random<L>,
) -> [L; 3] {
    let cosine = cosine(random.uniform_where(which));
    turned_lanes(axis, cosine, random.uniform_where(which))
}

/// Positions of particles at the light's surface and their directions, for the lanes in `which`; the cosine with
/// the normal is computed from a uniform number.
#[inline(always)]
pub fn rays<L: Lane>(
    sphere: &Sphere,
    cosine: impl Fn(L) -> L,
    (one, which): (L, L::Mask),
    random: &mut impl Random<L>,
) -> [[L; 3]; 2] {
    let (normal, direction) = match sphere.light {
        // A point of the disc is the foot of one of the sphere: by Lambert's law all of them are equally probable.
        BallLight::Distant(towards) => {
            (lambert(towards.each(one), cosine, which, random), (towards * -1.0).each(one))
        }
        light => {
            let height = random.uniform_where(which) * 2.0 - 1.0;
            let normal = turned_lanes(UP.each(one), height, random.uniform_where(which));
            let [x, y, z] = normal;
            let is_outwards = matches!(light, BallLight::BlackSphere(_));
            let axis = if is_outwards { normal } else { [x * -1.0, y * -1.0, z * -1.0] };
            (normal, lambert(axis, cosine, which, random))
        }
    };
    [along(sphere.centre.each(one), normal, one.each(radius(sphere))), direction]
}

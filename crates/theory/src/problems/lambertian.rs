//! A body under light from all sides: how long particles stay in it, and how often they collide.
//!
//! ```text
//! particles enter evenly over the boundary, with the Lambertian law cos θ/π about its normal
//! a = 1:                   mean path Σ w ℓ = 4V/S,   mean collisions Σ w r = (4/S) ∫σ_t dV
//! a > 0, non-terminating:   mean tentative collisions = (4/S) ∫σ̂ dV
//! every a, every rule:      Σ w r (1 − a) + w where it leaves = 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume` | σ_t in space, with bounds; a `ray` may be given, and is not walked | required |
//! | `albedo` | a in [0, 1]: a number, or a field in space such as `sines = { … }` | required unless swept |
//! | `phase.NAME = { … }` | a phase function: `trueflight list phases` | required |
//! | `sampling` | σ̂ in space of every estimator without its own: `constant`, or `local-majorants` with a `grid` | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! V and S are volume and surface of the bounds, whatever is in them: light from all sides fills a body that
//! does not absorb evenly, in all directions, however it scatters. So every heterogeneous medium has an
//! exact test of its flights, directions and lookups. A channel is there where its answer is known:
//!
//! | channel | for |
//! |---|---|
//! | `energy` | every experiment whose spread theory bounds, see `trueflight explain furnace` |
//! | `path length`, `collisions` | a = 1 everywhere and `σ̂ ≥ σ_t` |
//! | `tentative collisions` | the rule `non-terminating` alone, a > 0, any σ̂ that is constant or, in a box, local |
//!
//! `∫σ_t dV` is a cubature over chords of exact optical depths, with a stated error. Theory has no variance
//! of the counts and lengths of a walk. Their tails are light, and they are judged by twice the variance of
//! pilot draws.
//!
//! Source: A. Mazzolo, C. de Mulatier, A. Zoia, *Cauchy's formulas for random walks in bounded domains*,
//! Journal of Mathematical Physics 55, 083308 (2014); S. Blanco, R. Fournier, *An invariance property of
//! diffusive random walks*, Europhysics Letters 61 (2003).
//!
//! ```toml
//! title = "An example of lambertian"
//!
//! [problem.lambertian]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedo = 1
//! phase = "isotropic"
//! sampling = 1.2
//! estimators = [{ particle.rule = "analog" }, { particle.rule = "terminating" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use std::sync::OnceLock;

use super::{Problem, Scene};
use media::body::RayNeed;
use media::catalogue::Settings;
use media::{Body, Medium};
use numeric::geometry::frame::turned_lanes;
use numeric::geometry::{Bounds, Point};
use numeric::{Known, Lane};

pub use super::rod::Values;

/// A body under light from all sides.
#[derive(Clone)]
pub struct Lambertian {
    /// The medium in space.
    pub scene: Scene,
    medium: Medium,
    content: OnceLock<Option<Known>>,
}

impl Lambertian {
    /// The boundary.
    pub fn bounds(&self) -> Bounds {
        self.scene.volume.bounds()
    }

    /// `4/S`, 1/length².
    pub fn four_over_surface(&self) -> f64 {
        self.bounds().surface().map_or(0.0, |surface| 4.0 / surface)
    }

    /// `∫σ_t dV`, computed at its first use.
    pub fn content(&self, find: impl FnOnce() -> Option<Known>) -> Option<Known> {
        *self.content.get_or_init(find)
    }

    /// The point on the boundary that two uniform numbers choose, evenly, and the inward normal there.
    #[inline(always)]
    pub fn boundary_lanes<L: Lane>(&self, [u, v]: [L; 2]) -> [[L; 3]; 2] {
        let (zero, one) = (u.each(0.0), u.each(1.0));
        match self.bounds() {
            Bounds::Sphere { centre: Point([a, b, c]), radius } => {
                let [x, y, z] = turned_lanes([zero, zero, one], u * 2.0 - 1.0, v);
                let place = [x * radius + a, y * radius + b, z * radius + c];
                [place, [x * -1.0, y * -1.0, z * -1.0]]
            }
            Bounds::Box(within) => {
                let size = (within.high - within.low).0;
                let [a, b, c] = size;
                let areas = [b * c, c * a, a * b];
                // One number chooses the pair of faces, the face, and the coordinate across it.
                let left = u * (areas[0] + areas[1] + areas[2]);
                let not_first = u.each(areas[0]).at_most(left);
                let left = L::select(not_first, left - areas[0], left);
                let is_third = not_first & u.each(areas[1]).at_most(left);
                let left = L::select(is_third, left - areas[1], left);
                let axes = [!not_first, not_first & !is_third, is_third];
                let area = L::select(axes[1], u.each(areas[1]), u.each(areas[2]));
                let area = L::select(axes[0], u.each(areas[0]), area);
                let share = (left * 2.0 / area).or_less(u.each(2.0));
                let is_high = one.at_most(share);
                let along = L::select(is_high, share - 1.0, share).or_less(one);
                let facing = L::select(is_high, -one, one);
                let (mut place, mut inward) = ([zero; 3], [zero; 3]);
                for axis in 0..3 {
                    let (low, high) = (u.each(within.low.0[axis]), u.each(within.high.0[axis]));
                    let across = L::select(axes[(axis + 2) % 3], along, v) * size[axis] + low;
                    let face = L::select(is_high, high, low);
                    place[axis] = L::select(axes[axis], face, across);
                    inward[axis] = L::select(axes[axis], facing, zero);
                }
                [place, inward]
            }
            // Refused when it is read.
            Bounds::Everywhere => [[zero; 3], [zero, zero, one]],
        }
    }
}

impl Problem for Lambertian {
    /// The channels that theory predicts, see `estimators/lambertian`.
    type Value = Values;
    const RAY: RayNeed = RayNeed::Nothing;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let scene = Scene::bounded(body, settings)?;
        Some(Self { scene, medium: body?.medium(), content: OnceLock::new() })
    }

    super::in_space!();
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::Volume;
    use media::eq21::Eq21;
    use media::phase::{Phase, isotropic::Isotropic};
    use numeric::geometry::Aabb;
    use std::sync::Arc;

    fn under_light(volume: Arc<Volume>) -> Lambertian {
        let ray =
            numeric::geometry::Ray::new(Point([0.5; 3]), Point([0.0, 0.0, 1.0]), 1.0).expect("");
        let body = Body::Volume { name: String::new(), volume: volume.clone(), ray };
        let scene = Scene {
            volume,
            albedo: crate::problems::Albedo::Even(1.0),
            phase: Phase::Isotropic(Isotropic),
        };
        Lambertian { scene, medium: body.medium(), content: OnceLock::new() }
    }

    /// The place on the boundary that two numbers find, and the inward normal there.
    fn boundary(body: &Lambertian, u: f64, v: f64) -> (Point, Point) {
        let [place, inward] = body.boundary_lanes([u, v]);
        (Point(place), Point(inward))
    }

    #[test]
    fn places_lie_on_the_sphere_and_look_inward() {
        let sphere = under_light(Arc::new(Eq21));
        for (u, v) in [(0.0, 0.3), (0.4, 0.9), (0.999, 0.0)] {
            let (place, inward) = boundary(&sphere, u, v);
            assert!(((place - Point([0.0, 0.0, 10.0])).norm() - 10.0).abs() < 1e-13);
            assert!((place + inward * 10.0 - Point([0.0, 0.0, 10.0])).norm() < 1e-13);
        }
        assert!(
            (sphere.four_over_surface() * 4.0 * std::f64::consts::PI * 100.0 - 4.0).abs() < 1e-14
        );
    }

    #[test]
    fn each_face_of_a_box_gets_its_share() {
        let within = Aabb { low: Point([0.0; 3]), high: Point([1.0, 2.0, 3.0]) };
        let cuboid =
            under_light(Arc::new(media::constant::Constant::within(1.0, Bounds::Box(within))));
        // Areas 6, 3, 2 twice: of 11 parts u takes six for x, three for y, two for z.
        let (place, inward) = boundary(&cuboid, 1.0 / 11.0, 0.5);
        assert_eq!((inward, place.0[0]), (Point([1.0, 0.0, 0.0]), 0.0));
        assert!((place.0[1] - 2.0 / 3.0).abs() < 1e-14 && place.0[2] == 1.5);
        assert_eq!(boundary(&cuboid, 4.0 / 11.0, 0.5).1, Point([-1.0, 0.0, 0.0]));
        assert_eq!(boundary(&cuboid, 6.5 / 11.0, 0.5).1, Point([0.0, 1.0, 0.0]));
        assert_eq!(boundary(&cuboid, 8.5 / 11.0, 0.5).1, Point([0.0, -1.0, 0.0]));
        assert_eq!(boundary(&cuboid, 10.5 / 11.0, 0.5).1, Point([0.0, 0.0, -1.0]));
    }
}

//! Interpolation between the shadow rays of some points of a ray.
//!
//! In noise of k octaves a ray passes about 2ᵏ cells, and so does the shadow ray of each of its points: 4ᵏ cells in
//! all. The transmittance of shadow rays varies slowly with the point, except for the contribution of the smallest
//! cells, which averages out along the ray. In media of many pieces a few hundred shadow rays are therefore followed,
//! from even steps of the stretched variable x, and moments between them are interpolated:
//!
//! ```text
//! −ln E[X^k],  E[N^k],  E[N^k; through]   by the cubic through the four nearest rays
//! ```
//!
//! Each integral is computed with all the rays and with every other ray. The difference is part of its error, which
//! is then an estimate and no bound.
//!
//! Source: derived here.

use super::segment::Segment;
use numeric::Span;

/// Maximum number of pieces along a ray without interpolation.
pub const MANY: usize = 256;
/// Maximum number of panels between the pieces of a ray.
pub const PANELS: usize = 1024;
/// Number of pieces along all shadow rays together, about.
const WORK: usize = 1_800_000;
/// Minimum and maximum number of pairs of shadow rays.
const PAIRS: [usize; 2] = [48, 256];
/// Number of interpolated values of a [`Segment`].
const COUNT: usize = 16;

/// Ends of the panels of a ray in a medium of many pieces: every n-th of the pieces' ends, so that at most [`PANELS`]
/// remain, and true if some were left out.
///
/// Panels then hold pieces that their nodes do not resolve. These are the smallest ones, which average out.
pub fn thinned(ends: Vec<f64>) -> (Vec<f64>, bool) {
    let stride = ends.len().div_ceil(PANELS);
    if stride < 2 {
        return (ends, false);
    }
    let last = ends.last().copied();
    (ends.into_iter().step_by(stride).chain(last).collect(), true)
}

/// Shadow rays at even steps along a ray.
pub struct Shadows {
    from: f64,
    step: f64,
    rows: Vec<[f64; COUNT]>,
}

/// Set of the shadow rays between which values are interpolated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Among {
    /// All rays.
    All,
    /// Every other ray.
    Half,
}

impl Shadows {
    /// Follows shadow rays from places in the stretched variable; `None` if a moment is 0 or overflows.
    pub fn new(x: Span, pieces: usize, follow: impl Fn(f64) -> Segment + Sync) -> Option<Self> {
        let pairs = (WORK / (2 * pieces)).clamp(PAIRS[0], PAIRS[1]);
        let step = x.length() / (2 * pairs) as f64;
        let rows = crate::parallel::range(2 * pairs + 1, |i| {
            row(&follow(if i == 2 * pairs { x.to } else { x.from + step * i as f64 }))
        });
        let is_finite = rows.iter().flatten().all(|value| value.is_finite());
        is_finite.then_some(Self { from: x.from, step, rows })
    }

    /// Places of the rays: interpolants are smooth between them.
    pub fn places(&self) -> impl Iterator<Item = f64> {
        (1..self.rows.len() - 1).map(|i| self.from + self.step * i as f64)
    }

    /// Shadow ray of a place, interpolated.
    pub fn at(&self, x: f64, among: Among) -> Segment {
        let stride = if among == Among::Half { 2 } else { 1 };
        let last = (self.rows.len() - 1) / stride;
        let t = (x - self.from) / (self.step * stride as f64);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a number of rays
        let first = (t.max(1.0) as usize - 1).min(last - 3);
        let t = t - first as f64;
        let weights = [
            -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
            t * (t - 2.0) * (t - 3.0) / 2.0,
            -t * (t - 1.0) * (t - 3.0) / 2.0,
            t * (t - 1.0) * (t - 2.0) / 6.0,
        ];
        let mut result = [0.0; COUNT];
        for (i, weight) in weights.into_iter().enumerate() {
            let row = &self.rows[(first + i) * stride];
            result.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
        }
        segment(result)
    }
}

fn row(segment: &Segment) -> [f64; COUNT] {
    let Segment { powers, lookups: [_, n1, n2, n3, n4], through, error, size } = *segment;
    let [t0, t1, t2, t3, t4] = through;
    let [a, b, c, d, e] = powers.map(|power| -power.ln());
    [a, b, c, d, e, n1, n2, n3, n4, t0, t1, t2, t3, t4, error, size]
}

fn segment(
    [a, b, c, d, e, n1, n2, n3, n4, t0, t1, t2, t3, t4, error, size]: [f64; COUNT],
) -> Segment {
    Segment {
        powers: [a, b, c, d, e].map(|exponent: f64| (-exponent).exp()),
        lookups: [1.0, n1, n2, n3, n4],
        through: [t0, t1, t2, t3, t4],
        error: error.max(0.0),
        size: size.max(0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;
    use crate::problems::single_scattering::Lamp;
    use crate::problems::{Problem, SingleScattering};
    use crate::single::scene::StretchedPlace;
    use crate::single::{Camera, CameraTracking, RayNode, RayScene, Tracking};
    use media::noise::Noise;
    use media::phase::{Phase, isotropic::Isotropic};
    use media::{Control, Piecewise};
    use numeric::Known;
    use numeric::geometry::{Bounds, Point, Ray};
    use std::sync::Arc;

    fn in_noise(octaves: u32) -> SingleScattering {
        let noise = Noise::of_octaves(1.2, (1.0, octaves), 5, Bounds::Everywhere);
        let (origin, direction) = (Point([0.3, 0.7, -0.4]), Point([0.6, 0.5, 0.4]));
        let ray = Ray::new(origin, direction, 3.0).expect("a direction");
        let lamp = Lamp { position: Point([1.5, 0.0, 1.2]), power: 1.0 };
        let phase = Phase::Isotropic(Isotropic);
        SingleScattering::new(Arc::new(noise), ray, lamp, 0.95, phase).expect("off the line")
    }

    /// The other method follows the shadow ray of every node.
    #[test]
    fn integrals_by_interpolated_rays_are_within_the_error_of_those_by_all() {
        let problem = in_noise(5);
        let mesh = Mesh::new(problem.medium().clone());
        let (sampling, control) = (Piecewise::constant(1.2, mesh.support()), Control::None);
        for tracking in [Tracking::Exact, Tracking::Ratio { sampling: 1.2, control: 0.0 }] {
            let scene = || {
                let camera = Camera::new(&mesh, &sampling, &control, CameraTracking::Exact);
                RayScene::new(&problem, camera, tracking)
            };
            let (exact, mut quick) = (scene(), scene());
            assert!(exact.shadows.is_none());
            let x = Span::new(
                exact.unstretched(mesh.support().from),
                exact.unstretched(mesh.support().to),
            );
            let follow = |x: f64| exact.followed(exact.stretched(x), tracking);
            quick.shadows = Shadows::new(x, 1_000_000, follow);
            assert_eq!(quick.shadows.as_ref().expect("finite").rows.len(), 97);
            let scattered = |node: &RayNode| {
                let gained = node.extinction * node.transmittance * node.source;
                let [powers @ .., _] = node.shadow.powers;
                let [_, lookups, square, ..] = node.shadow.lookups;
                let [a, b, c, d] = powers.map(|power| gained * power);
                [a, b, c, d, gained * lookups, gained * square]
            };
            let [exact, quick] =
                [exact, quick].map(|scene| scene.integrate([1e-9; 6], Vec::new(), &scattered));
            for i in 0..6 {
                let off = (exact.value[i] - quick.value[i]).abs();
                let errors = [exact.error[i], quick.error[i]];
                let context = format!("{tracking:?} {i}: {:e} {off:e}, {errors:?}", exact.value[i]);
                assert!(off <= errors[0] + errors[1] + 1e-14 * exact.value[i].abs(), "{context}");
                assert!(errors[1] <= 1e-3 * exact.value[i].abs(), "{context}");
            }
        }
    }

    /// The other method follows the shadow rays of even panels.
    #[test]
    fn the_radiance_in_many_octaves_is_that_of_even_panels() {
        let problem = in_noise(8);
        let mesh = Mesh::new(problem.medium().clone());
        let (sampling, control) = (Piecewise::constant(1.2, mesh.support()), Control::None);
        let camera = Camera::new(&mesh, &sampling, &control, CameraTracking::Exact);
        let radiance = RayScene::new(&problem, camera, Tracking::Exact).radiance();
        let quick = crate::single::quick::radiance(&problem, 48);
        let off = (radiance.value - quick.value).abs();
        assert!(radiance.error < 1e-4 * radiance.value, "{radiance:?}");
        assert!(off <= 3.0 * quick.error + radiance.error, "{radiance:?}, {quick:?}");
    }

    /// The other method has a panel for each piece. Eight octaves have 570 pieces; the limit is 1024.
    #[test]
    fn pieces_that_are_not_resolved_average_out_within_the_error() {
        let problem = in_noise(11);
        let mesh = Mesh::new(problem.medium().clone());
        let medium = problem.medium();
        let (ends, is_thinned) = thinned(medium.support().cut(medium.breaks()));
        assert!(is_thinned && ends.len() <= PANELS + 1, "{}", ends.len());
        let (sampling, control) = (Piecewise::constant(1.2, mesh.support()), Control::None);
        let camera = Camera::new(&mesh, &sampling, &control, CameraTracking::Exact);
        let scene = RayScene::new(&problem, camera, Tracking::Exact);
        let scattered = |node: &RayNode| [node.extinction * node.transmittance * node.source];
        let result = scene.integrate([1e-9], Vec::new(), &scattered);
        let piece = |ends: &[f64]| {
            let rule = scene.rule();
            rule.integrate(ends[0], ends[1], |s| {
                let along = s - problem.foot();
                scattered(&scene.node(StretchedPlace { s, along, stretch: 1.0 }))[0]
            })
        };
        let exact: f64 = medium.support().cut(medium.breaks()).windows(2).map(piece).sum();
        let off = (result.value[0] - exact).abs();
        assert!(off <= result.error[0] && result.error[0] < 1e-4 * exact, "{off:e}, {exact:e}");
    }

    #[test]
    fn cubics_are_interpolated_exactly_by_all_and_by_half_of_the_rays() {
        let of = |x: f64| {
            let depth = Known::exact(1.0 + x * (0.3 + x * (0.2 - 0.1 * x)));
            Segment::exact(depth)
        };
        let shadows = Shadows::new(Span::new(-1.0, 2.0), 1_000_000, of).expect("finite");
        assert_eq!(shadows.rows.len(), 97);
        for x in [-1.0, -0.99, 0.123, 1.5, 1.999, 2.0] {
            for among in [Among::All, Among::Half] {
                let result = shadows.at(x, among);
                assert!((result.powers[0] / of(x).powers[0] - 1.0).abs() < 1e-13, "{x}");
                assert_eq!(result.lookups, [1.0, 0.0, 0.0, 0.0, 0.0]);
            }
        }
    }
}

//! A point from the light and a scattering of delta tracking, combined by multiple importance sampling.
//!
//! ```text
//! p = D/(Δθ r²),  q = c σ_t x,   f = σ_t S x T̂_shadow
//! X_p = f p^{β−1}/(p^β + q^β),   X_q = f q^{β−1}/(p^β + q^β)
//! ```
//!
//! x is the factor of the way from the ray's origin that both densities contain. It is the transmittance T, or,
//! where paths include all their null collisions, `Π (1 − σ_t/σ̂)` over these; there majorant transmittances
//! cancel. The shadow ray is equal for both and cancels, too.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*, SIGGRAPH 1995;
//! B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.

use super::null_path::NullPaths;
use super::predict::DENSITY;
use super::scene::{RayNode, RayScene, STEPS, StretchedPlace};
use super::{Collisions, ScoredDensity, TechniqueMoments};
use crate::light::Heuristic;
use crate::light::contour::Made;
use crate::problems::Problem;

/// Maximum number of halvings of panels towards the end of a ray.
const HALVINGS: u32 = 48;
/// Ratio of the density of delta tracking at half the distance to an end to that at the whole: above it σ_t does
/// not vanish at the end.
const FALLS: f64 = 0.75;
/// Ratio of two densities above which weights no longer change abruptly.
const NEGLIGIBLE: f64 = 8.0;

/// The two techniques.
pub struct Mis<'a> {
    /// The ray, the light, and the transmittances of points from the light.
    pub scene: &'a RayScene<'a>,
    /// Delta tracking.
    pub collisions: Collisions<'a>,
    /// Heuristic of the weights.
    pub heuristic: Heuristic,
    /// Null collisions, where paths include them.
    pub nulls: Option<NullPaths<'a>>,
}

impl Mis<'_> {
    /// Moments of the point from the light, and of the scattering of delta tracking.
    pub fn points(&self) -> [TechniqueMoments; 2] {
        match &self.nulls {
            Some(nulls) => self.by_null_paths(nulls),
            None => self.by_transmittances(),
        }
    }

    fn points_of(&self, technique: &ScoredDensity) -> TechniqueMoments {
        let mut kinks = self.layers();
        kinks.extend(self.collisions.sampling.knots());
        TechniqueMoments::of(self.scene, technique, kinks)
    }

    /// Places towards the ends of the ray, each half as far as the one before. Where σ_t vanishes, weights change from one
    /// technique to the other within a layer so thin that two resolutions may both miss it, and agree.
    fn layers(&self) -> Vec<f64> {
        let problem = self.scene.problem;
        let support = problem.medium().support();
        let mut cuts = Vec::new();
        for (end, inwards) in [(support.from, support.length()), (support.to, -support.length())] {
            let mut step = inwards / STEPS as f64;
            let densities = |step: f64| {
                let (s, along) = (end + step, end + step - problem.foot());
                let node = self.scene.node(StretchedPlace { s, along, stretch: 0.0 });
                [self.collisions.density(&node), self.source(&node)]
            };
            let [mut collision, mut source] = densities(step);
            for _ in 0..HALVINGS {
                if collision * NEGLIGIBLE < source {
                    break;
                }
                cuts.push(end + step);
                step *= 0.5;
                let [nearer, beside] = densities(step);
                if nearer > FALLS * collision {
                    break;
                }
                [collision, source] = [nearer, beside];
            }
        }
        cuts
    }

    fn source(&self, node: &RayNode) -> f64 {
        self.scene.problem.equiangular_density_beyond(node.along)
    }

    fn by_transmittances(&self) -> [TechniqueMoments; 2] {
        let scatters = |node: &RayNode| node.extinction * node.source;
        let collision = |node: &RayNode| self.collisions.density(node);
        let source = |node: &RayNode| self.source(node);
        let shared = |own: f64, other: f64| self.heuristic.shared(own, other);
        let gain = |node: &RayNode| scatters(node) / shared(source(node), collision(node));
        let walked = |node: &RayNode| {
            node.transmittance * (scatters(node) / shared(collision(node), source(node)))
        };
        let blur = |node: &RayNode| 2.0 * (node.error[1] + DENSITY);
        let (blur, weighted): (&dyn Fn(&RayNode) -> f64, _) = (&blur, None);
        let first =
            ScoredDensity { density: &source, gain: &gain, blur, by_collisions: None, weighted };
        let by_collisions = Some(&self.collisions);
        let second =
            ScoredDensity { density: &collision, gain: &walked, blur, by_collisions, weighted };
        [first, second].map(|technique| self.points_of(&technique))
    }

    fn by_null_paths(&self, nulls: &NullPaths) -> [TechniqueMoments; 2] {
        let worth = |node: &RayNode| self.collisions.worth(node);
        let ratio = |node: &RayNode| node.extinction * self.collisions.scatters / self.source(node);
        let by_point = |node: &RayNode| nulls.weights(Made::ByPoint, node.s, ratio(node));
        let first = ScoredDensity {
            density: &|node| self.source(node),
            gain: &worth,
            blur: &|_| DENSITY,
            by_collisions: None,
            weighted: Some(&by_point),
        };
        let by_collision = |node: &RayNode| {
            // Of all walks through σ̂ only those without a real collision reach the point.
            let result = nulls.weights(Made::ByCollision, node.s, ratio(node));
            result.map(|moments| moments.map(|moment| moment / node.transmittance))
        };
        let second = ScoredDensity {
            density: &|node| self.collisions.density(node),
            gain: &worth,
            blur: &|node| node.error[1],
            by_collisions: Some(&self.collisions),
            weighted: Some(&by_collision),
        };
        [first, second].map(|technique| self.points_of(&technique))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Camera, CameraTracking, Tracking};
    use super::*;
    use crate::Mesh;
    use crate::problems::SingleScattering;
    use crate::problems::single_scattering::Lamp;
    use media::phase::{Phase, henyey_greenstein::HenyeyGreenstein};
    use media::radial::Radial;
    use media::{Control, Piecewise};
    use numeric::geometry::{Point, Ray};
    use std::sync::Arc;

    /// σ_t is 0 at both ends of the ray. There weights change within a hundredth of a panel: the difference of two
    /// resolutions is smaller than their errors.
    #[test]
    fn shares_of_both_techniques_add_up_within_their_error() {
        let field = Radial::new(Point([0.0, 0.0, 10.0]), 8.0, [0.6, -0.6, 0.0, 0.0]);
        let origin = Point([1.298_734_533_625_156, 2.622_477_847_216_871, -5.0]);
        let target = Point([1.293_711_350_122_188_2, -1.072_042_908_981_399_9, 15.0]);
        let ray = Ray::new(origin, target - origin, 26.0).expect("a direction");
        let side = ray.direction.cross(Point([0.0, 1.0, 0.0])).normalised().expect("a direction");
        let turn = 1.492_871_371_159_629_8_f64;
        let aside = side * turn.cos() + ray.direction.cross(side) * turn.sin();
        let foot = ray.at(26.0 * 0.572_752_918_270_362_1);
        let lamp = Lamp { position: foot + aside * 0.032_058_999_009_489_43, power: 1.0 };
        let phase = HenyeyGreenstein::new(-0.300_314_935_290_657_8).expect("|g| < 1");
        let phase = Phase::HenyeyGreenstein(phase);
        let problem = SingleScattering::new(Arc::new(field), ray, lamp, 0.7, phase).ok();
        let problem = problem.expect("off the line");
        let (medium, mesh) = (problem.medium(), Mesh::new(problem.medium().clone()));
        let sampling = &Piecewise::constant(0.91, mesh.support());
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let camera = Camera::new(&mesh, sampling, &Control::None, CameraTracking::Exact);
            let scene = &RayScene::new(&problem, camera, Tracking::Exact);
            let collisions = Collisions { medium, sampling, scatters: 0.7 };
            let [light, walk] = Mis { scene, collisions, heuristic, nulls: None }.points();
            let truth = scene.radiance();
            let mean = light.raw.0[0] + walk.raw.0[0];
            let (off, error) = ((mean.value - truth.value).abs(), mean.error);
            assert!(off <= error + truth.error, "{heuristic:?}: {off:e} beyond {error:e}");
            assert!(error < 1e-9 * truth.value, "{heuristic:?}: {error:e}");
        }
    }
}

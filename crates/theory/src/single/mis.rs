//! A point from the light and a scattering of delta tracking, which share what they find.
//!
//! ```text
//! p = D/(Δθ r²),  q = c σ_t x,   f = σ_t S x T̂_shadow
//! X_p = f p^{β−1}/(p^β + q^β),   X_q = f q^{β−1}/(p^β + q^β)
//! ```
//!
//! x is what both densities know of the way from the ray's origin: the transmittance T, or, where paths are those
//! with all their null collisions, `Π (1 − σ_t/σ̂)` over these; there majorant transmittances cancel. The shadow ray
//! is the same for both and cancels, too.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*, SIGGRAPH 1995;
//! B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.

use super::null_path::{Made, NullPaths, Weighted};
use super::predict::DENSITY;
use super::scene::{Node, Scene};
use super::{Collisions, Points, Technique};
use crate::Heuristic;

/// The two techniques.
pub struct Mis<'a> {
    /// The ray, the light, and how points from the light get their transmittances.
    pub scene: &'a Scene<'a>,
    /// Delta tracking.
    pub collisions: Collisions<'a>,
    /// How they share.
    pub heuristic: Heuristic,
    /// Null collisions, where paths are with them.
    pub nulls: Option<NullPaths<'a>>,
}

impl Mis<'_> {
    /// What the point from the light brings, and what the scattering of delta tracking does.
    pub fn points(&self) -> [Points; 2] {
        match &self.nulls {
            Some(nulls) => self.by_null_paths(nulls),
            None => self.by_transmittances(),
        }
    }

    fn source(&self, node: &Node) -> f64 {
        self.scene.problem.equiangular_density_beyond(node.along)
    }

    fn by_transmittances(&self) -> [Points; 2] {
        let scatters = |node: &Node| node.extinction * node.source;
        let collision = |node: &Node| self.collisions.density(node);
        let source = |node: &Node| self.source(node);
        let shared = |own: f64, other: f64| self.heuristic.shared(own, other);
        let gain = |node: &Node| scatters(node) / shared(source(node), collision(node));
        let walked = |node: &Node| {
            node.transmittance * (scatters(node) / shared(collision(node), source(node)))
        };
        let blur = |node: &Node| 2.0 * (node.error[1] + DENSITY);
        let (blur, weighted): (&dyn Fn(&Node) -> f64, _) = (&blur, None);
        let first = Technique { density: &source, gain: &gain, blur, found: None, weighted };
        let found = Some(&self.collisions);
        let second = Technique { density: &collision, gain: &walked, blur, found, weighted };
        [first, second].map(|technique| Points::of(self.scene, &technique))
    }

    fn by_null_paths(&self, nulls: &NullPaths) -> [Points; 2] {
        let worth = |node: &Node| self.collisions.worth(node);
        let ratio = |node: &Node| node.extinction * self.collisions.scatters / self.source(node);
        let by_point = |node: &Node| nulls.weights(Made::ByPoint, node.s, ratio(node));
        let first = Technique {
            density: &|node| self.source(node),
            gain: &worth,
            blur: &|_| DENSITY,
            found: None,
            weighted: Some(&by_point),
        };
        let by_collision = |node: &Node| {
            // Of all walks through σ̂, those without a real collision.
            let found = nulls.weights(Made::ByCollision, node.s, ratio(node));
            let through = |moment: f64| moment / node.transmittance;
            Weighted { powers: found.powers.map(through), errors: found.errors.map(through) }
        };
        let second = Technique {
            density: &|node| self.collisions.density(node),
            gain: &worth,
            blur: &|node| node.error[1],
            found: Some(&self.collisions),
            weighted: Some(&by_collision),
        };
        [first, second].map(|technique| Points::of(self.scene, &technique))
    }
}

//! Delta tracking to a scattering.
//!
//! ```text
//! p(s) = c σ_t T,   X = S T̂_shadow/c
//! ```
//!
//! c, the probability that a real collision scatters, is the albedo, or 1 where the albedo is a weight.

use super::scene::{RayNode, RayScene};
use super::{ScoredDensity, TechniqueMoments};
use crate::prediction::raw::{Raw, added, poisson};
use media::{Medium, OpticalDepth, Piecewise};
use numeric::{Lane, Span};

/// Walks through a majorant.
#[derive(Clone, Copy)]
pub struct Collisions<'a> {
    /// Medium of the walks.
    pub medium: &'a Medium,
    /// σ̂ ≥ σ_t.
    pub sampling: &'a Piecewise,
    /// c, the probability that a real collision scatters.
    pub scatters: f64,
}

impl Collisions<'_> {
    fn before(&self, s: f64) -> Span {
        Span::new(self.medium.support().from, s)
    }

    /// The mean number of null collisions up to a point: `∫σ̂ − τ`.
    fn nulls(&self, s: f64) -> f64 {
        let before = self.before(s);
        self.sampling.optical_depth(before).value - self.medium.optical_depth(before).value
    }

    /// The density of scatterings.
    pub fn density(&self, node: &RayNode) -> f64 {
        node.extinction * self.scatters * node.transmittance
    }

    /// Moments of draws that scatter at the first real collision.
    pub fn points(&self, scene: &RayScene) -> TechniqueMoments {
        let technique = ScoredDensity {
            density: &|node| self.density(node),
            gain: &|node| self.worth(node),
            blur: &|node| node.error[1],
            by_collisions: Some(self),
            weighted: None,
        };
        TechniqueMoments::of(scene, &technique, self.sampling.knots().to_vec())
    }

    /// Score of a scattering without its shadow ray.
    pub fn worth(&self, node: &RayNode) -> f64 {
        node.source / self.scatters
    }

    /// `E[N^k]` of a walk that scatters at a node, with its shadow ray, and of the walks that are absorbed there,
    /// per walk that scatters.
    pub fn lookups_at(&self, node: &RayNode) -> Raw {
        let walked = added([1.0; 5], poisson(self.nulls(node.s)));
        let scattered = added(walked, node.shadow.lookups);
        let absorbed = (1.0 - self.scatters) / self.scatters;
        std::array::from_fn(|k| scattered[k] + absorbed * walked[k])
    }

    /// `E[N^k; no collision]`.
    pub fn lookups_of_escape(&self) -> Raw {
        let end = self.medium.support().to;
        let transmittance = Lane::exp(-self.medium.optical_depth(self.before(end)).value);
        poisson(self.nulls(end)).map(|moment| transmittance * moment)
    }
}

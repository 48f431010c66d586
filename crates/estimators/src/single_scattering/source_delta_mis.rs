//! Equiangular points and delta tracking together, weighted by multiple importance sampling.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! p₁ = D/(Δθ r²),   p₂ = c σ_t x,   f = σ_t S x T̂_shadow
//! both   X = Σ_{i=1,2} f(sᵢ) w_i/p_i,   w_i = p_i^β/(p₁^β + p₂^β),   0 where there is no s₂
//! one    X = 2 f(sᵢ) w_i/p_i,   i = 1 or 2 with probability ½ each
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | σ̄ ≥ σ_t on the ray | required here or in the case |
//! | `camera` | what x is: `"exact"`, the transmittance T in closed form, or `"ratio"`, `Π (1 − σ_t/σ̄)` over the null collisions of the path, by ratio tracking where the point is from the light | `"exact"` |
//! | `absorption` | `"weight"`: c = 1; `"analog"`: the albedo c is the probability that a real collision scatters | `"weight"` |
//! | `samples` | `"both"` techniques in a draw, or `"one"` of them | `"both"` |
//! | `heuristic` | β: `"balance"` (1) or `"power"` (2) | `"balance"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }` | `"exact"` |
//!
//! With a tracked camera the weights are those of the null-scattering path: both densities contain the same
//! majorant transmittances and all factors of the shadow ray, which cancel. A shadow ray is cast even where x is 0.
//!
//! The variance stays bounded however near the light is.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*,
//! SIGGRAPH 1995, section 3; C. Kulla, M. Fajardo, *Importance Sampling Techniques for Path Tracing
//! in Participating Media*, Computer Graphics Forum 31 (2012); B. Miller, I. Georgiev, W. Jarosz, *A null-scattering
//! path integral formulation of light transport*, ACM Transactions on Graphics 38 (2019), section 5.
//!
//! ```toml
//! title = "An example of source-delta-mis"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! estimators = ["source-delta-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{Absorption, ByPlan, Plan, Planned, Technique, Vertices};
use crate::Inputs;
use crate::setup::heuristic;
use media::catalogue::Settings;

/// Equiangular points and delta tracking.
pub type SourceDeltaMis = ByPlan<Both>;

/// Both techniques of the plan.
#[derive(Debug, Clone)]
pub struct Both;

impl Planned for Both {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Plan> {
        let light = Vertices::FROM_LIGHT.read(settings, &["exact", "ratio"]);
        let absorption = Absorption::read(settings);
        let samples = settings.word_or("samples", &["both", "one"], "both");
        let heuristic = heuristic::read(settings);
        let vertices = || {
            let (collision, is_one) = (Some(absorption?), samples? == "one");
            Some(Vertices { collision, is_one, heuristic: heuristic?, ..light? })
        };
        Plan::read(vertices().map(Technique::Vertices), settings)
    }
}

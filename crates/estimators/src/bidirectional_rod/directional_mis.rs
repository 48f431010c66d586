//! All techniques of bidirectional path tracing, weighted by densities of directions only.
//!
//! Unbiased for: σ̂ ≥ σ_t, with tracked connections where `σ_t/σ̂` is one number; refused elsewhere, and for τ > 12.
//!
//! ```text
//! X = Σ_s w_s c_s,   w_s ∝ 1 for s = 0 and s = r + 2, else ([ρ_{s−1}]_{s≥2} [ρ_s]_{s≤r})^{−β}
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `heuristic` | `"balance"`: β = 1, `"power"`: β = 2 | `"balance"` |
//! | `connection` | `"exact"`: `T̂ = exp(−∫σ_t)`, no lookups; `"ratio"`: tracked through σ̂ | `"exact"` |
//! | `subpaths` | `"independent"`: each technique has two of its own; `"shared"`: one walk from the light and one from the sensor serve all techniques and orders | `"independent"` |
//!
//! These are the weights of renderers that leave the densities of distances out: those of real scatterings and null
//! vertices. Paths are divided by their full densities, so that it is unbiased for `σ̂ ≥ σ_t` like `technique`.
//!
//! Renderers draw shared subpaths. Contributions of techniques have the same moments, but are correlated, and the
//! variance of their sum is bounded: its root is at most the sum of theirs.
//!
//! Source: Miller, Georgiev, Jarosz 2019, section 5.5 and table 1, “BPT: Directional MIS”.
//!
//! ```toml
//! title = "An example of directional-mis"
//!
//! [problem.rod]
//! medium = 1.2
//! span = [0, 1.5]
//! albedo = 0.8
//! forward = 0.7
//! sensor = "transmitted"
//! orders = 2
//! sampling = 2
//! estimators = ["directional-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{DIRECTIONAL, Estimate};

/// Directional weights; σ̂ is its input.
pub type DirectionalMis = Estimate<DIRECTIONAL>;

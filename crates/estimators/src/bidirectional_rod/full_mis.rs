//! All techniques of bidirectional path tracing, weighted by densities of whole paths.
//!
//! Unbiased for: σ̂ ≥ σ_t, with tracked connections where `σ_t/σ̂` is one number; refused elsewhere, and for τ > 12.
//!
//! ```text
//! X = Σ_s w_s c_s,   w_s = c_s^{−β}/Σⱼ cⱼ^{−β},   c₀ = c_{r+2} = 1,  cⱼ = T̂_{j−1} [a ρ_{j−1}]_{j≥2} [a ρⱼ]_{j≤r}
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `heuristic` | `"balance"`: β = 1, `"power"`: β = 2 | `"balance"` |
//! | `connection` | `"exact"`: `T̂ⱼ = exp(−∫σ_t)` of every segment, no lookups; `"ratio"`: the null-scattering path, `T̂ⱼ = ∏ (1 − σ_t/σ̂)` over the null vertices of every segment | `"exact"` |
//! | `subpaths` | `"independent"`: each technique has two of its own; `"shared"`: one walk from the light and one from the sensor serve all techniques and orders | `"independent"` |
//!
//! On a segment that one technique tracks by ratio and another by delta tracking the densities of the null
//! vertices are in the ratio `p_rt/p_dt = ∏ σ̂/(σ̂ − σ_t) = 1/T̂ⱼ`: no optical depth is needed. By the
//! balance heuristic all techniques score the same function of the path, `1/Σⱼ cⱼ⁻¹ ≤ 1/2`. With
//! `"ratio"`, `σ_t/σ̂` must be one number, for theory.
//!
//! Renderers draw shared subpaths. Contributions of techniques have the same moments, but are correlated, and the
//! variance of their sum is bounded: its root is at most the sum of theirs.
//!
//! Source: Miller, Georgiev, Jarosz 2019, sections 5.2 and 5.5, Eqs. 42–44, and table 1, “BPT: Full MIS”.
//!
//! ```toml
//! title = "An example of full-mis"
//!
//! [problem.rod]
//! medium = 1.2
//! span = [0, 1.5]
//! albedo = 0.8
//! forward = 0.7
//! sensor = "transmitted"
//! orders = 2
//! sampling = 2
//! estimators = ["full-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Estimate, FULL};

/// Weights by whole paths; σ̂ is its input.
pub type FullMis = Estimate<FULL>;

//! A single technique of bidirectional path tracing.
//!
//! Unbiased for: σ̂ ≥ σ_t, with tracked connections where `σ_t/σ̂` is one number; refused elsewhere, and for τ > 12.
//!
//! ```text
//! X = c_s = T̂_{s−1} [a ρ_{s−1}]_{s≥2} [a ρ_s]_{s≤r},   1 for s = 0 and s = r + 2
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `light-vertices` | s, the light's own included; the sensor has the other r + 2 − s | required |
//! | `connection` | `"exact"`: `T̂ = exp(−∫σ_t)`, no lookups; `"ratio"`: tracked through σ̂ | `"exact"` |
//!
//! s = 0 is unidirectional path tracing, s = r + 2 light tracing, s = 1 next-event estimation at the last vertex
//! from the sensor. 0 ≤ X ≤ 1. With `"ratio"`, `σ_t/σ̂` must be one number, for theory.
//! Each order of the problem with such a technique is a channel.
//!
//! Source: E. Lafortune, Y. Willems, *Rendering Participating Media with Bidirectional Path Tracing*, Eurographics
//! Workshop on Rendering 1996; Miller, Georgiev, Jarosz 2019, Eq. 44.
//!
//! ```toml
//! title = "An example of technique"
//!
//! [problem.rod]
//! medium = 1.2
//! span = [0, 1.5]
//! albedo = 0.8
//! forward = 0.7
//! sensor = "transmitted"
//! orders = 2
//! sampling = 2
//! estimators = [{ technique.light-vertices = 1 }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Estimate, TECHNIQUE};
use media::catalogue::Settings;
use theory::problems::bidirectional_rod::HIGHEST_ORDER;
use theory::rod::bidirectional::Combination;

/// A single technique; σ̂ is its input.
pub type Technique = Estimate<TECHNIQUE>;

/// Reads `light-vertices`.
pub(super) fn combination(settings: &Settings) -> Option<Combination> {
    let s = settings.count("light-vertices", 0..=HIGHEST_ORDER as u64 + 2)?;
    #[allow(clippy::cast_possible_truncation)] // at most seven
    Some(Combination::Technique(s as usize))
}

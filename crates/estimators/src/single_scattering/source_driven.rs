//! Source-driven scattering: points at equal angles as seen from the light (Cauchy, equiangular).
//!
//! Unbiased for: whatever its transmittances are unbiased for.
//!
//! ```text
//! θ uniform over the angles of the support,  s = foot + D tan θ,  p(s) = D/(Δθ r²)
//! X = T̂ σ_t S T̂_shadow / p
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `camera` | `"exact"`, `"ratio"` (with σ̂ and, for residual ratio, a control) or `"delta"` (σ̂ ≥ σ_t) | `"exact"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }` | `"exact"` |
//!
//! With the exact camera an own `sampling` or a `control` is read and not used: it may stay when the camera
//! changes.
//!
//! Unbiased wherever its transmittances are; the density is positive everywhere and cancels 1/r², so
//! that the variance stays bounded however near the light is.
//!
//! Source: C. Kulla, M. Fajardo, *Importance Sampling Techniques for Path Tracing in Participating
//! Media*, Computer Graphics Forum 31 (2012), section 4; Szirmay-Kalos et al. 2017, section 4.3.
//!
//! ```toml
//! title = "An example of source-driven"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! estimators = ["source-driven"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{ByPlan, Plan, Planned, Technique, Vertices};
use crate::Inputs;
use media::catalogue::Settings;

/// Source-driven scattering.
pub type SourceDriven = ByPlan<Points>;

/// The points of the plan.
#[derive(Debug, Clone)]
pub struct Points;

impl Planned for Points {
    const INPUTS: Inputs = Inputs::BOTH;

    fn read(settings: &Settings) -> Option<Plan> {
        let vertices = Vertices::FROM_LIGHT.read(settings, &["exact", "ratio", "delta"]);
        Plan::read(vertices.map(Technique::Vertices), settings)
    }
}

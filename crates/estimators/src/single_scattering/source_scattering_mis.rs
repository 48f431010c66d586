//! Source- and scattering-driven points together, weighted by the balance heuristic.
//!
//! Unbiased for: σ_m ≥ 0; refused elsewhere.
//!
//! ```text
//! X = Σ_{i=1,2} T̂ σ_t S T̂_shadow / (p₁ + p₂)  at sᵢ,  sᵢ of density pᵢ
//! p₁ = D/(Δθ r²),   p₂ = σ_m e^{−∫σ_m} / (1 − e^{−τ_m})
//! ```
//!
//! Each of the two points has a walk and a shadow ray of its own. Settings are those of
//! `scattering-driven`.
//!
//! Unbiased wherever the transmittances are: p₁ is positive everywhere, so that σ_m may be zero where
//! σ_t is not, but not negative. The variance stays bounded however near the light is.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*,
//! SIGGRAPH 1995, section 3; Szirmay-Kalos et al. 2017, section 4.3.
//!
//! ```toml
//! title = "An example of source-scattering-mis"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! control = 0.6
//! estimators = ["source-scattering-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{ByPlan, Plan, Planned, Technique, Vertices};
use crate::Inputs;
use media::catalogue::Settings;

/// Source- and scattering-driven points.
pub type SourceScatteringMis = ByPlan<Points>;

/// The points of the plan.
#[derive(Debug, Clone)]
pub struct Points;

impl Planned for Points {
    const INPUTS: Inputs = Inputs::BOTH;

    fn read(settings: &Settings) -> Option<Plan> {
        let vertices =
            Vertices { main: true, ..Vertices::FROM_LIGHT }.read(settings, &["exact", "ratio"]);
        Plan::read(vertices.map(Technique::Vertices), settings)
    }
}

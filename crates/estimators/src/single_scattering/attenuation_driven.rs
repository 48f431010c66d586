//! Attenuation-driven: the interaction points of one transmittance walk are the scattering points.
//!
//! Unbiased for: every σ̂ > 0 where σ_t or the residual is not 0.
//!
//! ```text
//! X = Σᵢ T̂(tᵢ) σ_t(tᵢ) S(tᵢ) T̂_shadow(tᵢ) / σ̂(tᵢ),   tᵢ a Poisson process of rate σ̂
//! T̂(tᵢ) = T_c(tᵢ) ∏_{j<i} (1 − rⱼ),  rⱼ = (σ_t − σ_c)/σ̂
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | σ̂ > 0 wherever the residual is not zero, and wherever σ_t is not | required here or in the case |
//! | `control` | σ_c | none |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, for each point | `"exact"` |
//!
//! Unbiased there, by Campbell's theorem: interaction points have the density σ̂. It is proportional to none of the
//! factors of the integrand, and the variance grows as `1/D³` when the light comes near the ray.
//!
//! All four moments are known: those of the rest of a walk obey a chain of linear equations.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.3.
//!
//! ```toml
//! title = "An example of attenuation-driven"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! estimators = ["attenuation-driven"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{ByPlan, Plan, Planned, Technique};
use crate::Inputs;
use media::catalogue::Settings;

/// Attenuation-driven scattering.
pub type AttenuationDriven = ByPlan<Points>;

/// The points of the plan.
#[derive(Debug, Clone)]
pub struct Points;

impl Planned for Points {
    const INPUTS: Inputs = Inputs::BOTH;

    fn read(settings: &Settings) -> Option<Plan> {
        Plan::read(Some(Technique::Interactions), settings)
    }
}

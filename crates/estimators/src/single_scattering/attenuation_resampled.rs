//! Attenuation-driven with sampling importance resampling: one shadow ray for a whole walk.
//!
//! Unbiased for: every σ̂ > 0 where σ_t or the residual is not 0.
//!
//! ```text
//! X = (Σᵢ |yᵢ|) sgn(y_J) T̂_shadow(t_J),  yᵢ = T̂(tᵢ) σ_t(tᵢ) S(tᵢ)/σ̂(tᵢ),  P(J = i) = |yᵢ|/Σ|y|
//! ```
//!
//! Settings and domain are those of `attenuation-driven`. The chosen point is kept while the walk goes
//! on (reservoir sampling), with one random number for each interaction point.
//!
//! The variance is never below that of `attenuation-driven`; it saves shadow rays. Lookups are predicted where
//! shadow rays have none: the choice of the point depends on all of them.
//!
//! Source: J. Talbot, D. Cline, P. Egbert, *Importance resampling for global illumination*,
//! Eurographics Symposium on Rendering (2005); Szirmay-Kalos et al. 2017, section 4.3.
//!
//! ```toml
//! title = "An example of attenuation-resampled"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! estimators = ["attenuation-resampled"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{ByPlan, Plan, Planned, Technique};
use crate::Inputs;
use media::catalogue::Settings;

/// Attenuation-driven scattering, resampled.
pub type AttenuationResampled = ByPlan<Points>;

/// The points of the plan.
#[derive(Debug, Clone)]
pub struct Points;

impl Planned for Points {
    const INPUTS: Inputs = Inputs::BOTH;

    fn read(settings: &Settings) -> Option<Plan> {
        Plan::read(Some(Technique::Resampled), settings)
    }
}

//! Several equiangular points with the continuous transmittance of one walk.
//!
//! Unbiased for: every σ̂ > 0 where the residual is not 0.
//!
//! ```text
//! X = (1/n) Σⱼ T̂(sⱼ) σ_t(sⱼ) S(sⱼ) T̂_shadow(sⱼ) / p(sⱼ),   p(s) = D/(Δθ r²)
//! T̂(s) = T_c(s) ∏_{tᵢ<s} (1 − rᵢ),  one walk for all s
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `points` | n, from 1 to 16 | 4 |
//! | `sampling` | σ̂ > 0 wherever the residual is not zero | required here or in the case |
//! | `control` | σ_c | none |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, for each point | `"exact"` |
//!
//! Between interaction points `T̂` falls off exponentially with the control, so that one walk over the whole ray
//! serves every point. Each point is unbiased. The points are not independent, and the four moments take their
//! joint distribution into account.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.3.
//!
//! ```toml
//! title = "An example of shared-walk"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! estimators = [{ shared-walk.points = 4 }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{ByPlan, Plan, Planned, Technique};
use super::shared::MAX_POINTS;
use crate::Inputs;
use media::catalogue::Settings;

/// Points that share a walk.
pub type SharedWalk = ByPlan<Points>;

/// The points of the plan.
#[derive(Debug, Clone)]
pub struct Points;

impl Planned for Points {
    const INPUTS: Inputs = Inputs::BOTH;

    fn read(settings: &Settings) -> Option<Plan> {
        let points = settings.count_or("points", 1..=MAX_POINTS as u64, 4);
        let points = points.and_then(|points| usize::try_from(points).ok());
        Plan::read(points.map(Technique::Shared), settings)
    }
}

//! Scattering at the first real collision of delta tracking.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! s the first tᵢ with uᵢ < σ_t(tᵢ)/σ̄(tᵢ),  p(s) = σ_t T;   X = S(s) T̂_shadow, 0 if there is none
//! analog: scattered if uᵢ < a σ_t/σ̄, else absorbed,  p(s) = a σ_t T;   X = (S/a) T̂_shadow, 0 if absorbed
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | σ̄ ≥ σ_t on the ray | required here or in the case |
//! | `absorption` | `"weight"`: the albedo is a factor of S; `"analog"`: it is the probability that a real collision scatters | `"weight"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }` | `"exact"` |
//!
//! The density does not depend on the light: the variance grows as `1/D³` when the light comes near the ray.
//!
//! Source: E. R. Woodcock, T. Murphy, P. Hemmings, T. Longworth, *Techniques used in the GEM code
//! for Monte Carlo neutronics calculations*, ANL-7050 (1965); Szirmay-Kalos et al. 2017, section 4.3.
//!
//! ```toml
//! title = "An example of delta-tracking"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! estimators = ["delta-tracking"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{Absorption, ByPlan, Plan, Planned, Technique, Vertices};
use crate::Inputs;
use media::catalogue::Settings;

/// Scattering at the first real collision.
pub type DeltaTracking = ByPlan<Collision>;

/// The collision of the plan.
#[derive(Debug, Clone)]
pub struct Collision;

impl Planned for Collision {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Plan> {
        let vertices = Absorption::read(settings).map(|absorption| {
            let collision = Some(absorption);
            Vertices { light: false, collision, ..Vertices::FROM_LIGHT }
        });
        Plan::read(vertices.map(Technique::Vertices), settings)
    }
}

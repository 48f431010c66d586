//! Scattering-driven: points where the main part of the extinction would scatter, analytically.
//!
//! Unbiased for: σ_m > 0 where σ_t > 0; refused elsewhere.
//!
//! ```text
//! p(s) = σ_m(s) e^{−∫₀ˢ σ_m} / (1 − e^{−τ_m}),   X = T̂ σ_t S T̂_shadow / p
//! ```
//!
//! The main part σ_m is the control: straight pieces, as those through explorer points.
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `control` | σ_m: `explorers`, `mean`, `constant`, … | required here or in the case |
//! | `camera` | `"exact"`, or `"ratio"`: residual ratio through σ̂ with σ_m as the control | `"exact"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }` | `"exact"` |
//!
//! With the exact camera a `sampling` of its own is read and not used: it may stay when the camera changes.
//!
//! Unbiased where `σ_m > 0` wherever `σ_t > 0`; refused elsewhere. The density does not depend on the light: the
//! variance grows as `1/D³` when the light comes near the ray.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.3.
//!
//! ```toml
//! title = "An example of scattering-driven"
//!
//! [problem.single-scattering]
//! volume = 0.8
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
//! light.position = [0.5, 0, 2.5]
//! albedo = 0.9
//! phase = "isotropic"
//! sampling = 1
//! control = 0.6
//! estimators = ["scattering-driven"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::plan::{ByPlan, Plan, Planned, Technique, Vertices};
use crate::Inputs;
use media::catalogue::Settings;

/// Scattering-driven.
pub type ScatteringDriven = ByPlan<Points>;

/// The points of the plan.
#[derive(Debug, Clone)]
pub struct Points;

impl Planned for Points {
    const INPUTS: Inputs = Inputs::BOTH;

    fn read(settings: &Settings) -> Option<Plan> {
        let vertices = Vertices { light: false, main: true, ..Vertices::FROM_LIGHT }
            .read(settings, &["exact", "ratio"]);
        Plan::read(vertices.map(Technique::Vertices), settings)
    }
}

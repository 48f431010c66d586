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
//! Unbiased where `σ_m > 0` wherever `σ_t > 0`; refused elsewhere. The density knows nothing of the
//! light: the variance grows as `1/D³` when the light comes near the ray.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.3.

use super::Connection;
use super::in_packets;
use super::main_part::{self, MainPart};
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SingleScattering;
use theory::single::{Points, Technique};

/// Scattering-driven.
#[derive(Debug, Clone)]
pub struct ScatteringDriven {
    connection: Connection,
}

impl Estimator<SingleScattering> for ScatteringDriven {
    const INPUTS: Inputs = Inputs::BOTH;
    in_packets!(self => self.connection.kind(false, true));

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { connection: Connection::read(settings, &["exact", "ratio"])? })
    }

    fn inputs(&self) -> Inputs {
        Inputs { control: true, ..self.connection.inputs() }
    }

    fn label(&self, _: bool) -> String {
        self.connection.label()
    }

    fn needs(&self) -> Option<&'static str> {
        self.connection.needs()
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        main_part::require(setup)?;
        self.connection.domain(setup)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        let main = MainPart::of(setup);
        let density = |s: f64| main.map_or(0.0, |main| main.density(s));
        let technique = Technique {
            density: &|node| density(node.s),
            gain: &|node| node.extinction * node.source / density(node.s),
            blur: &|node| main.map_or(0.0, |main| main.blur(node.s)),
            found: None,
            weighted: None,
        };
        let scene = self.connection.scene(setup, main_part::cuts(setup));
        Points::of(&scene, &technique).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        self.connection.draw(setup, medium, [false, true], rng)
    }
}

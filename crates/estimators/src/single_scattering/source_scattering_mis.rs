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

use super::Connection;
use super::in_packets;
use super::main_part::{self, MainPart};
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SingleScattering;
use theory::single::predict::DENSITY;
use theory::single::{Node, Points, Technique};

/// Source- and scattering-driven points.
#[derive(Debug, Clone)]
pub struct SourceScatteringMis {
    connection: Connection,
}

impl Estimator<SingleScattering> for SourceScatteringMis {
    const INPUTS: Inputs = Inputs::BOTH;
    in_packets!(self => self.connection.kind(true, true));

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
        main_part::require_straight(setup)?;
        self.connection.domain(setup)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        let main = MainPart::of(setup);
        let source = |node: &Node| setup.problem.equiangular_density_beyond(node.along);
        let scattering = |node: &Node| main.map_or(0.0, |main| main.density(node.s));
        let gain = |node: &Node| node.extinction * node.source / (source(node) + scattering(node));
        let blur = |node: &Node| main.map_or(DENSITY, |main| main.blur(node.s));
        let scene = self.connection.scene(setup, main_part::cuts(setup));
        let points = |density: &dyn Fn(&Node) -> f64| {
            Points::of(
                &scene,
                &Technique { density, gain: &gain, blur: &blur, found: None, weighted: None },
            )
        };
        points(&source).plus(&points(&scattering)).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        self.connection.draw(setup, medium, [true, true], rng)
    }
}

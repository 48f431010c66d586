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
//! With the exact camera a `sampling` of its own or a `control` is read and not used: it may stay when the camera changes.
//!
//! Unbiased wherever its transmittances are; the density is positive everywhere and cancels 1/r², so
//! that the variance stays bounded however near the light is.
//!
//! Source: C. Kulla, M. Fajardo, *Importance Sampling Techniques for Path Tracing in Participating
//! Media*, Computer Graphics Forum 31 (2012), section 4; Szirmay-Kalos et al. 2017, section 4.3.

use super::Connection;
use super::in_packets;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SingleScattering;
use theory::single::predict::DENSITY;
use theory::single::{Points, Technique};

/// Source-driven scattering.
#[derive(Debug, Clone)]
pub struct SourceDriven {
    connection: Connection,
}

impl Estimator<SingleScattering> for SourceDriven {
    const INPUTS: Inputs = Inputs::BOTH;
    in_packets!(self => self.connection.kind(true, false));

    fn read(settings: &Settings) -> Option<Self> {
        let connection = Connection::read(settings, &["exact", "ratio", "delta"])?;
        Some(Self { connection })
    }

    fn inputs(&self) -> Inputs {
        self.connection.inputs()
    }

    fn label(&self, _: bool) -> String {
        self.connection.label()
    }

    fn needs(&self) -> Option<&'static str> {
        self.connection.needs()
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        self.connection.domain(setup)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        let problem = &setup.problem;
        let technique = Technique {
            density: &|node| problem.equiangular_density_beyond(node.along),
            gain: &|node| {
                node.extinction * node.source / problem.equiangular_density_beyond(node.along)
            },
            blur: &|_| DENSITY,
            found: None,
            weighted: None,
        };
        Points::of(&self.connection.scene(setup, Vec::new()), &technique).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        self.connection.draw(setup, medium, [true, false], rng)
    }
}

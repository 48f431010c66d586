//! Spectral multiple importance sampling: the first scattering of a hero's walk and a shadow ray from there, weighted by
//! the densities of all heroes.
//!
//! ```text
//! X_λ = q_λ/Σ_h w_h q_h · p_λ(cos θ) Φ/(4π r²) T̂_λ,   q_λ the density of the walk, and of a shadow ray that is tracked
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the hero's σ̂ | `"exact"` |
//! | `hero` | the law of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, on shadow rays too where they are tracked | required here or in the case |
//!
//! The first factor never exceeds `1/w_λ`. Means and lookups are known; the variance is at most that of `independent`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), sections 5.3 and 5.4.

use super::walk::{self, Steps};
use super::{Shadow, alone, predict_balanced, realisable};
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Lookups;
use crate::problems::SpectralSingleScattering;
use crate::problems::spectral_single_scattering::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::Prediction;

/// The balance heuristic over heroes.
#[derive(Debug, Clone)]
pub struct SpectralMis {
    /// The law of the hero.
    pub heroes: Heroes,
    /// How shadow rays are tracked.
    pub shadow: Shadow,
}

impl Steps for SpectralMis {}

impl Estimator<SpectralSingleScattering> for SpectralMis {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let (heroes, shadow) = (Heroes::read(settings), Shadow::read(settings));
        Some(Self { heroes: heroes?, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        self.shadow.label(&self.heroes)
    }

    fn domain(&self, setup: &Setup<SpectralSingleScattering>) -> Result<(), Refusal> {
        realisable(setup, &self.heroes, self.shadow)
    }

    fn predict(&self, setup: &Setup<SpectralSingleScattering>) -> Prediction {
        let heroes = self.heroes.of(setup.channels.len());
        predict_balanced(&alone(setup, self.shadow), &heroes)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        walk::draw(self, (&self.heroes, self.shadow), setup, medium, rng)
    }
}

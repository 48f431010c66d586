//! Spectral multiple importance sampling: the analog walk of a hero, weighted by the balance heuristic.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! X_λ = a_λ^r/Σ_h w_h a_h^r where it leaves after r scatterings,  the walk with the albedo of the hero
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! No draw exceeds `1/w_λ`: the variance is finite however long the rod is. With equal probabilities it is that of
//! history-aware spectral tracking.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use super::{Coloured, scored, spectrum, walk};
use crate::setup::heroes::Heroes;
use crate::{Estimator, Refusal, Setup};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use theory::Prediction;
use theory::spectral_rod::Tracker;

/// The balance heuristic over heroes.
#[derive(Debug, Clone)]
pub struct SpectralMis {
    /// The distribution of the hero.
    pub heroes: Heroes,
}

impl walk::Page for SpectralMis {
    #[inline(always)]
    fn heroes(&self) -> Option<&Heroes> {
        Some(&self.heroes)
    }

    #[inline(always)]
    fn weights(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MOST_CHANNELS] {
        let count = albedos.len();
        let mut weights = walk::relative(albedos, hero, order);
        let mut density = 0.0;
        for (channel, weight) in weights[..count].iter().enumerate() {
            density += self.heroes.probability(count, channel) * weight;
        }
        for weight in &mut weights[..count] {
            *weight /= density;
        }
        weights
    }
}

impl<P: Coloured> Estimator<P> for SpectralMis {
    scored!();

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { heroes: Heroes::read(settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.heroes.label()
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        walk::require(setup, &self.heroes)
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        let heroes = self.heroes.of(setup.problem.colours().albedos.len());
        spectrum(setup, heroes, Tracker::Mis).predict()
    }
}

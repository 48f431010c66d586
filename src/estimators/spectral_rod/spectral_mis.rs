//! Spectral multiple importance sampling: the analog walk of a hero, weighted by the balance heuristic.
//!
//! ```text
//! X_λ = a_λ^r/Σ_h w_h a_h^r where it leaves after r scatterings,  the walk with the albedo of the hero
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | the law of the hero: `"uniform"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! No draw exceeds `1/w_λ`: the variance is finite however long the rod is. With equal probabilities it is that of
//! history-aware spectral tracking.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use super::{Coloured, spectrum, walk};
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::spectral_rod::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::Prediction;
use crate::theory::spectral_rod::Tracker;

/// The balance heuristic over heroes.
#[derive(Debug, Clone)]
pub struct SpectralMis {
    heroes: Heroes,
}

impl<P: Coloured> Estimator<P> for SpectralMis {
    const INPUTS: Inputs = Inputs::SAMPLING;

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

    #[inline(always)]
    fn draw(&self, setup: &Setup<P>, medium: &Lookups, rng: &mut Stream) -> Draw<Values> {
        let colours = setup.problem.colours();
        let count = colours.albedos.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let left = P::walk(setup, medium, rng, colours.albedos[hero]);
        let mut weights = [1.0; MOST_CHANNELS];
        for _ in 0..left.order {
            // Relative to the hero's, which was scattered so often.
            for (weight, albedo) in weights.iter_mut().zip(&colours.albedos) {
                *weight *= albedo / colours.albedos[hero];
            }
        }
        let mut density = 0.0;
        for (channel, weight) in weights[..count].iter().enumerate() {
            density += self.heroes.probability(count, channel) * weight;
        }
        for weight in &mut weights[..count] {
            *weight /= density;
        }
        Draw::free(colours.values(left.end, &weights), left.lookups)
    }
}

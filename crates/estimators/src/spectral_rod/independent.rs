//! Independent tracking: one channel a draw, by an analog walk with its own albedo.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! X_h = 1/w_h where it leaves, the others 0,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 6.

use super::{Coloured, scored, spectrum, walk};
use crate::setup::heroes::Heroes;
use crate::{Estimator, Refusal, Setup};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use theory::Prediction;
use theory::spectral_rod::Tracker;

/// Independent tracking.
#[derive(Debug, Clone)]
pub struct Independent {
    heroes: Heroes,
}

impl walk::Page for Independent {
    #[inline(always)]
    fn heroes(&self) -> Option<&Heroes> {
        Some(&self.heroes)
    }

    #[inline(always)]
    fn weights(&self, albedos: &[f64], hero: usize, _: u32) -> [f64; MOST_CHANNELS] {
        let mut weights = [0.0; MOST_CHANNELS];
        weights[hero] = 1.0 / self.heroes.probability(albedos.len(), hero);
        weights
    }
}

impl<P: Coloured> Estimator<P> for Independent {
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
        spectrum(setup, heroes, Tracker::Independent).predict()
    }
}

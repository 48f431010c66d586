//! Independent tracking: one channel a draw, by an analog walk with its own albedo.
//!
//! ```text
//! X_h = 1/w_h where it leaves, the others 0,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | the law of the channel: `"uniform"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 6.

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

/// Independent tracking.
#[derive(Debug, Clone)]
pub struct Independent {
    heroes: Heroes,
}

impl<P: Coloured> Estimator<P> for Independent {
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
        spectrum(setup, heroes, Tracker::Independent).predict()
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<P>, medium: &Lookups, rng: &mut Stream) -> Draw<Values> {
        let colours = setup.problem.colours();
        let hero = self.heroes.choose(colours.albedos.len(), rng.uniform());
        let left = P::walk(setup, medium, rng, colours.albedos[hero]);
        let mut weights = [0.0; MOST_CHANNELS];
        weights[hero] = 1.0 / self.heroes.probability(colours.albedos.len(), hero);
        Draw::free(colours.values(left.end, &weights), left.lookups)
    }
}

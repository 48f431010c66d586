//! Independent tracking: one channel a draw, by an analog walk through its own medium.
//!
//! ```text
//! X_h = 1/w_h, the others 0,  h of probability w_h;   Var X_λ = 1/w_λ − 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | the law of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! Whatever becomes of the walk, it scores: in a furnace this is what colour noise costs without multiple importance
//! sampling, and nothing else.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 6.

use super::realisable;
use super::walk::{self, Steps};
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::SpectralFurnace;
use crate::problems::spectral_furnace::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::{Prediction, spectral_furnace as theory};

/// One channel a draw.
#[derive(Debug, Clone)]
pub struct Independent {
    heroes: Heroes,
}

impl Steps for Independent {}

impl Estimator<SpectralFurnace> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { heroes: Heroes::read(settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.heroes.label()
    }

    fn domain(&self, setup: &Setup<SpectralFurnace>) -> Result<(), Refusal> {
        realisable(setup, &self.heroes)
    }

    fn predict(&self, setup: &Setup<SpectralFurnace>) -> Prediction {
        theory::independent(&self.heroes.of(setup.channels.len()))
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<SpectralFurnace>, _: &Lookups, rng: &mut Stream) -> Draw<Values> {
        let count = setup.channels.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let (_, lookups) = walk::walk(self, setup, hero, rng);
        let mut scores = [0.0; MOST_CHANNELS];
        scores[hero] = 1.0 / self.heroes.probability(count, hero);
        Draw::free(setup.problem.values(scores), lookups)
    }
}

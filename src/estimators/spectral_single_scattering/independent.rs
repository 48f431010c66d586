//! Independent tracking: one channel a draw, by analog delta tracking through its own medium.
//!
//! ```text
//! X_h = p_h(cos θ) Φ/(4π r²) T̂_h/w_h where the walk scatters, the others 0,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the same σ̂ | `"exact"` |
//! | `hero` | the law of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, on shadow rays too where they are tracked | required here or in the case |
//!
//! All moments are known: `E[X_λ^k] = w_λ^{1−k} E[x_λ^k]`, x a draw of `delta-tracking` in that channel.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 6.

use super::walk::{self, Steps};
use super::{Shadow, alone, predict_independent, realisable};
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::SpectralSingleScattering;
use crate::problems::spectral_single_scattering::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::Prediction;

/// One channel a draw.
#[derive(Debug, Clone)]
pub struct Independent {
    heroes: Heroes,
    shadow: Shadow,
}

/// The walk of one hero, which no other could have made.
struct Alone;

impl Steps for Alone {}

impl Estimator<SpectralSingleScattering> for Independent {
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
        predict_independent(&alone(setup, self.shadow), &heroes)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralSingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let count = setup.channels.len();
        let hero = self.heroes.choose(count, rng.uniform());
        let (lit, mut scores) = (&setup.problem.channels[hero], [0.0; MOST_CHANNELS]);
        let (s, mut path, mut lookups) = walk::scattering(&Alone, setup, hero, medium, rng);
        if let Some(s) = s {
            let asked = (setup, hero..hero + 1);
            let (through, cast) = walk::cast(&Alone, self.shadow, asked, &mut path, s, rng);
            let chance = self.heroes.probability(count, hero);
            scores[hero] = lit.source(s) / lit.albedo() * through[hero] / chance;
            lookups += cast;
        }
        Draw::free(setup.problem.values(scores), lookups)
    }
}

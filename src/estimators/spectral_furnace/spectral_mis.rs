//! Spectral multiple importance sampling: a hero's walk, weighted by the densities of all heroes.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h,   f_λ the density of the walk in the channel λ: distances, events, directions
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | the law of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! `Σ_λ w_λ X_λ = 1` holds for every single draw and is checked. No draw exceeds `1/w_λ`, so that the variance of a
//! channel is at most `1/w_λ − 1`; what it is, theory does not know.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 5.1, Algorithm 1.

use super::realisable;
use super::walk::{self, Steps};
use crate::catalogue::Settings;
use crate::estimators::spectral_lit_rod::weighing::Weighing;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Lookups;
use crate::problems::SpectralFurnace;
use crate::problems::spectral_furnace::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::{Prediction, spectral_furnace as theory};

/// The balance heuristic over heroes.
#[derive(Debug, Clone)]
pub struct SpectralMis {
    /// The law of the hero.
    pub heroes: Heroes,
}

impl Steps for SpectralMis {}

/// Makes one draw by the steps of a walk, weighted in some way.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    (heroes, weighing): (&Heroes, Weighing),
    setup: &Setup<SpectralFurnace>,
    rng: &mut Stream,
) -> Draw<Values> {
    let count = setup.channels.len();
    let hero = heroes.choose(count, rng.uniform());
    let (path, lookups) = walk::walk(steps, setup, hero, rng);
    let scores = path.score(setup, heroes, weighing);
    let weighted = scores[..count].iter().enumerate();
    let sum: f64 = weighted.map(|(channel, x)| heroes.probability(count, channel) * x).sum();
    Draw { value: setup.problem.values(scores), lookups, defect: (sum - 1.0).abs() }
}

impl SpectralMis {
    /// How it weights a walk: there are no shadow rays.
    pub const WEIGHING: Weighing = Weighing { has_next_event: false, ..Weighing::RIGHT };
}

impl Estimator<SpectralFurnace> for SpectralMis {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const HAS_INVARIANT: bool = true;

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
        theory::balanced(&self.heroes.of(setup.channels.len()))
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<SpectralFurnace>, _: &Lookups, rng: &mut Stream) -> Draw<Values> {
        draw(self, (&self.heroes, Self::WEIGHING), setup, rng)
    }
}

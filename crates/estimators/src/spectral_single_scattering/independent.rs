//! Independent tracking: one channel a draw, by analog delta tracking through its own medium.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_h = p_h(cos θ) Φ/(4π r²) T̂_h/w_h where the walk scatters, the others 0,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the same σ̂ | `"exact"` |
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, on shadow rays too where they are tracked | required here or in the case |
//!
//! All moments are known: `E[X_λ^k] = w_λ^{1−k} E[x_λ^k]`, x a draw of `delta-tracking` in that channel.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 6.

use super::walk::{self, Right};
use super::{Shadow, alone, realisable};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::setup::walker::Walker;
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, walks};
use ::theory::problems::SpectralSingleScattering;
use ::theory::{Prediction, spectral_single_scattering as theory};
use media::catalogue::Settings;

/// Delta tracking of one channel a draw.
#[derive(Debug, Clone)]
pub struct Independent {
    /// The distribution of the channel.
    heroes: Heroes,
    /// Walker of the channel.
    walker: Walker,
    /// Tracking of shadow rays.
    shadow: Shadow,
}

impl Estimator<SpectralSingleScattering> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let (heroes, shadow) = (Heroes::read(settings), Shadow::read(settings));
        let heroes = heroes?;
        Some(Self { walker: Walker::Hero(heroes.clone()), heroes, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        self.shadow.label(&self.heroes.label())
    }

    fn needs(&self) -> Option<&'static str> {
        self.shadow.needs()
    }

    fn domain(&self, setup: &Setup<SpectralSingleScattering>) -> Result<(), Refusal> {
        self.walker.require(&setup.channels)?;
        channels::require_majorants(&setup.channels)?;
        realisable(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SpectralSingleScattering>) -> Prediction {
        theory::independent(&alone(setup, self.shadow), &self.heroes.of(setup.channels.len()))
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<SpectralSingleScattering>, request: Request) {
        walks::by(
            kernel,
            setup,
            request,
            |level, medium, request| {
                walk::packets::<false>(level, (&self.walker, self.shadow), setup, medium, request)
            },
            #[inline(always)]
            |medium, rng| {
                walk::draw::<false>(Right, (&self.walker, self.shadow), setup, medium, rng)
            },
        );
    }
}

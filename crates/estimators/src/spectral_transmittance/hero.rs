//! The walk of one hero channel scores all channels, divided by the hero's density alone.
//!
//! Unbiased for: a constant σ̂ > 0 in each channel; with `collisions = "delta"` σ̂ ≥ σ_t, > σ_t where another
//! channel has null collisions; refused elsewhere.
//!
//! ```text
//! X_λ = f_λ/p_h,  h of probability w_h,  f and p as in the walk
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `collisions` | `"ratio"` or `"delta"` | `"ratio"` |
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel; at least σ_t for `"delta"` | required here or in the case |
//!
//! With delta tracking the variance is infinite where the hero's σ̂ touches its σ_t and another channel's does not,
//! and the draws are biased where it does so on an interval: both are refused. Multiple importance sampling solves
//! this: see `spectral-mis`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use super::{trackers, walk};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::{Estimator, Refusal, Setup};
use media::catalogue::Settings;
use theory::problems::SpectralTransmittance;
use theory::spectral::Tracker;

/// A single hero, without multiple importance sampling.
#[derive(Debug, Clone)]
pub struct Hero {
    delta: bool,
    heroes: Heroes,
}

impl Estimator<SpectralTransmittance> for Hero {
    fn read(settings: &Settings) -> Option<Self> {
        let (delta, heroes) = (walk::read_delta(settings), Heroes::read(settings));
        Some(Self { delta: delta?, heroes: heroes? })
    }

    fn label(&self, _: bool) -> String {
        walk::label(self.delta, &self.heroes.label())
    }

    fn domain(&self, setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
        self.heroes.require(setup.channels.len())?;
        channels::require_constants(&setup.channels)?;
        if self.delta {
            channels::require_majorants(&setup.channels)?;
            channels::require_room(&setup.channels, false)?;
        }
        Ok(())
    }

    trackers!(self => new, &self.heroes, Tracker::Hero { delta: self.delta });
}

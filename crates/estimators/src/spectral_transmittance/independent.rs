//! Independent tracking: each channel by walks of its own, through its own σ̂.
//!
//! Unbiased for: a constant σ̂ > 0 in each channel, ≥ σ_t with `collisions = "delta"`; refused elsewhere.
//!
//! ```text
//! one channel a draw   X_h = x_h/w_h, the others 0,  h of probability w_h
//! all channels in turn X_λ = x_λ, each by a walk of its own
//! x = Π (1 − σ_t/σ̂) (ratio) or 1 where no collision is real (delta)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `collisions` | `"ratio"` or `"delta"` | `"ratio"` |
//! | `channels` | `"one"` a draw, or `"all"` in turn | `"one"` |
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel; at least σ_t for `"delta"` | required here or in the case |
//!
//! Unbiased there. With one channel a draw the colour noise is the largest possible.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 6.

use super::{trackers, walk};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::{Estimator, Refusal, Setup};
use media::catalogue::Settings;
use theory::problems::SpectralTransmittance;
use theory::spectral::Tracker;

/// Independent tracking.
#[derive(Debug, Clone)]
pub struct Independent {
    delta: bool,
    in_turn: bool,
    heroes: Heroes,
}

impl Independent {
    fn tracker(&self) -> Tracker {
        let delta = self.delta;
        if self.in_turn { Tracker::InTurn { delta } } else { Tracker::Independent { delta } }
    }
}

impl Estimator<SpectralTransmittance> for Independent {
    fn read(settings: &Settings) -> Option<Self> {
        let delta = walk::read_delta(settings);
        let channels = settings.word_or("channels", &["one", "all"], "one");
        let heroes = Heroes::read(settings);
        Some(Self { delta: delta?, in_turn: channels? == "all", heroes: heroes? })
    }

    fn label(&self, _: bool) -> String {
        let in_turn = "all channels in turn".to_owned();
        walk::label(self.delta, &if self.in_turn { in_turn } else { self.heroes.label() })
    }

    fn domain(&self, setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
        self.heroes.require(setup.channels.len())?;
        channels::require_constants(&setup.channels)?;
        if self.delta { channels::require_majorants(&setup.channels) } else { Ok(()) }
    }

    trackers!(self => new, &self.heroes, self.tracker());
}

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
//! | `hero` | the law of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel; at least σ_t for `"delta"` | required here or in the case |
//!
//! Unbiased there. With one channel a draw the colours are as noisy as they can be.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 6.

use fearless_simd::Level;

use super::walk;
use crate::kernels::packet::Request;
use crate::kernels::packet::spectral::{self as packet, Rule};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SpectralTransmittance;
use theory::problems::spectral_transmittance::Values;
use theory::spectral::Tracker;

/// Independent tracking.
#[derive(Debug, Clone)]
pub struct Independent {
    delta: bool,
    in_turn: bool,
    heroes: Heroes,
}

impl Estimator<SpectralTransmittance> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

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

    fn predict(&self, setup: &Setup<SpectralTransmittance>) -> Prediction {
        let delta = self.delta;
        let tracker =
            if self.in_turn { Tracker::InTurn { delta } } else { Tracker::Independent { delta } };
        walk::spectrum(setup, &self.heroes, tracker).predict(&setup.problem.luminance)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let count = setup.channels.len();
        let chosen = if self.in_turn {
            0..count
        } else {
            let hero = self.heroes.choose(setup.channels.len(), rng.uniform());
            hero..hero + 1
        };
        let (mut found, mut lookups) = ([0.0; MOST_CHANNELS], 0);
        for hero in chosen {
            let own = (hero, self.delta);
            let passed = walk::walk(setup, medium, rng, own, hero..hero + 1);
            let value = if self.delta { 1.0 } else { passed.ratios[hero] };
            let weight =
                if self.in_turn { 1.0 } else { 1.0 / self.heroes.probability(count, hero) };
            found[hero] = if passed.is_alive { value * weight } else { 0.0 };
            lookups += passed.lookups;
        }
        Draw::free(setup.problem.values(&found[..count]), lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        if self.in_turn {
            return Some(request);
        }
        let tracker = Tracker::Independent { delta: self.delta };
        let rule = Rule { tracker, is_common: false, heroes: &self.heroes };
        packet::walks(level, setup, rule, medium, request)
    }
}

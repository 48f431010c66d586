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
//! | `hero` | the law of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel; at least σ_t for `"delta"` | required here or in the case |
//!
//! With delta tracking the variance is infinite where the hero's σ̂ touches its σ_t and another channel's does
//! not, and the draws are biased where it does so on a stretch: both are refused. What multiple importance
//! sampling is for: see `spectral-mis`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

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

/// One hero, without multiple importance sampling.
#[derive(Debug, Clone)]
pub struct Hero {
    delta: bool,
    heroes: Heroes,
}

impl Estimator<SpectralTransmittance> for Hero {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

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

    fn predict(&self, setup: &Setup<SpectralTransmittance>) -> Prediction {
        let tracker = Tracker::Hero { delta: self.delta };
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
        let hero = self.heroes.choose(setup.channels.len(), rng.uniform());
        let passed = walk::walk(setup, medium, rng, (hero, self.delta), 0..count);
        let mut found = [0.0; MOST_CHANNELS];
        if passed.is_alive {
            let density = if self.delta { passed.ratios[hero] } else { 1.0 };
            for (channel, found) in found[..count].iter_mut().enumerate() {
                let relative = walk::relative_density(setup, channel, hero, passed.lookups);
                *found = relative * passed.ratios[channel] / density;
            }
        }
        Draw::free(setup.problem.values(&found[..count]), passed.lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let tracker = Tracker::Hero { delta: self.delta };
        let rule = Rule { tracker, is_common: false, heroes: &self.heroes };
        packet::walks(level, setup, rule, medium, request)
    }
}

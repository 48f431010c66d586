//! Spectral tracking: one σ̂ for all channels, and chances of the next event that depend on all of them.
//!
//! Unbiased for: one constant σ̂ ≥ σ_t for all channels, and `forward = 1`; refused elsewhere.
//!
//! ```text
//! an event e = null, scattered, absorbed of chance P_e;  w_λ ← w_λ μ_e,λ/(μ̄ P_e);  X_λ = w_λ at the emitter
//! average  P_e = mean μ_e/μ̄     maximum  P_e = max μ_e/Σ_e max μ_e     history  P_e = mean w μ_e/(μ̄ mean w)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"`, `"maximum"` or `"history"` | `"average"` |
//! | `sampling` | one constant σ̂ ≥ σ_t for all channels | required here or in the case |
//!
//! For rods in which light goes on forward (`forward = 1`): what a weight becomes where light turns, and from which length
//! on its variance is infinite, see `spectral-rod`. Forward, variances are finite, and known. An absorbing channel makes them
//! large all the same: its chance to absorb is that of all, and the weights of those that survive grow.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5.1.

use fearless_simd::Level;

use super::{packet, realisable, spectrum};
use crate::kernels::packet::Request;
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::setup::walker::read_chances;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SpectralLitRod;
use theory::problems::spectral_lit_rod::Values;
use theory::spectral::Chances;
use theory::spectral_lit_rod::Tracker;

/// Spectral tracking.
#[derive(Debug, Clone)]
pub struct SpectralTracking {
    chances: Chances,
}

impl Estimator<SpectralLitRod> for SpectralTracking {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { chances: read_chances(settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.chances.label().into()
    }

    fn domain(&self, setup: &Setup<SpectralLitRod>) -> Result<(), Refusal> {
        realisable(setup, &Heroes::Uniform)?;
        channels::require_common(&setup.channels)?;
        let turns = |(_, forward): &(usize, &f64)| **forward < 1.0;
        let turns = (1..).zip(&setup.problem.forward).find(turns);
        turns.map_or(Ok(()), |(channel, forward)| {
            let found = format!("forward = {forward} in channel {channel}");
            Err(Refusal::mismatch("light that goes on forward", found))
        })
    }

    fn predict(&self, setup: &Setup<SpectralLitRod>) -> Prediction {
        let tracker = Tracker::Tracking(self.chances);
        spectrum(setup, &Heroes::Uniform, tracker).predict(setup.laws)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralLitRod>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let (common, count) = (&setup.channels[0], setup.channels.len());
        let mut cursor = common.sampling.begin();
        let (mut weights, mut shares) = ([1.0; MOST_CHANNELS], [[0.0; 3]; MOST_CHANNELS]);
        let mut lookups = 0;
        loop {
            let (depth, number) = (-rng.ln_uniform(), rng.uniform());
            if common.sampling.fly(&mut cursor, depth).is_none() {
                return Draw::free(setup.problem.values(weights), lookups);
            }
            lookups += 1;
            for (channel, share) in shares[..count].iter_mut().enumerate() {
                let real = medium.channel(channel).extinction(cursor.t) / common.majorant;
                let scattered = real * setup.problem.albedo(channel, cursor.t);
                *share = [1.0 - real, scattered, real - scattered];
            }
            let chances =
                self.chances.of_events(count, |channel| shares[channel], &weights[..count]);
            let event = usize::from(number >= chances[0]);
            if number >= chances[0] + chances[1] {
                return Draw::free(setup.problem.values([0.0; MOST_CHANNELS]), lookups);
            }
            for (weight, share) in weights[..count].iter_mut().zip(&shares) {
                *weight *= share[event] / chances[event];
            }
        }
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralLitRod>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::tracking::walks(level, self.chances, setup, medium, request)
    }
}

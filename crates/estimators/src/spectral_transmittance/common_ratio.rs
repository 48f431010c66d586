//! Ratio tracking of all channels at once, through one σ̂ for all.
//!
//! Unbiased for: every constant σ̂ > 0.
//!
//! ```text
//! X_λ = Π (1 − σ_λ(tᵢ)/μ̄),  tᵢ a Poisson process of rate μ̄
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | one constant σ̂ > 0 for all channels | required here or in the case |
//!
//! Nothing is chosen by chance but the places: where the densities of the channels are
//! alike it has the least variance of all.
//!
//! Source: J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating Attenuation in Participating
//! Media*, ACM Transactions on Graphics 33 (2014), with one majorant for all channels.

use fearless_simd::Level;

use super::walk;
use crate::kernels::packet::Request;
use crate::kernels::packet::spectral::{self as packet, Rule};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SpectralTransmittance;
use theory::problems::spectral_transmittance::Values;
use theory::spectral::Tracker;

/// The ratio tracker of all channels.
#[derive(Debug, Clone)]
pub struct CommonRatio;

impl Estimator<SpectralTransmittance> for CommonRatio {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    fn domain(&self, setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
        channels::require_constants(&setup.channels)?;
        channels::require_common(&setup.channels)
    }

    fn predict(&self, setup: &Setup<SpectralTransmittance>) -> Prediction {
        let tracker = Tracker::Hero { delta: false };
        walk::spectrum(setup, &Heroes::Uniform, tracker).predict(&setup.problem.luminance)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let count = setup.channels.len();
        let passed = walk::walk(setup, medium, rng, (0, false), 0..count);
        Draw::free(setup.problem.values(&passed.ratios[..count]), passed.lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let tracker = Tracker::Hero { delta: false };
        let rule = Rule { tracker, is_common: true, heroes: &Heroes::Uniform };
        packet::walks(level, setup, rule, medium, request)
    }
}

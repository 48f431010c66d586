//! Ratio tracking: keep, at each tentative collision, the share that is null.
//!
//! ```text
//! X = ∏ᵢ (1 − σ_t(tᵢ)/σ̂(tᵢ)),  tᵢ a Poisson process of rate σ̂ on [0, ℓ]
//! ```
//!
//! Unbiased for every σ̂ that is positive wherever σ_t is. Where `σ̂ < σ_t` the factor is negative
//! and the variance grows; where `σ̂ ≥ σ_t` throughout, X lies in [0, 1]. It is `double` without a
//! control, and shares its code: the same random numbers make the same draws.
//!
//! ```text
//! J_k = ∫ σ̂ r^k,  r = σ_t/σ̂,  lookups Poisson(∫σ̂)
//! ```
//!
//! Source: J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating Attenuation in
//! Participating Media*, ACM Transactions on Graphics 33 (2014), section 3.

use fearless_simd::Level;

use super::double::{predict_weighted, unbiased_where_covered};
use crate::catalogue::Settings;
use crate::estimators::packet::{self, Request};
use crate::estimators::rules::Weight;
use crate::estimators::walkers::{self, Walkers};
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup, walk};
use crate::media::Extinction;
use crate::problems::Transmittance;
use crate::rng::Stream;
use crate::theory::Prediction;

/// Ratio tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Ratio;

impl Estimator<Transmittance> for Ratio {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const KEEPS_BOOKS: bool = true;
    const IN_PACKETS: bool = true;
    const ORDER_FREE: bool = true;

    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        unbiased_where_covered(setup)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        predict_weighted(setup)
    }

    #[inline(always)]
    fn draw<M: Extinction>(
        &self,
        setup: &Setup<Transmittance>,
        medium: &M,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        walk::product(setup, &Weight, medium, rng)
    }

    fn walkers<'a>(
        &'a self,
        setup: &'a Setup<Transmittance>,
        request: walkers::Request<'a>,
    ) -> Option<Box<dyn Walkers + 'a>> {
        walkers::product(setup, Weight, request)
    }

    fn draw_packets<'a, M: Extinction>(
        &self,
        level: Level,
        setup: &Setup<Transmittance>,
        medium: &M,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::product(level, setup, &Weight, medium, request)
    }
}

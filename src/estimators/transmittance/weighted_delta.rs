//! Weighted delta tracking: a σ̂ that is no majorant, paid for with signed weights.
//!
//! ```text
//! real with probability σ_t/(σ_t + |σ̂ − σ_t|), which ends the walk with X = 0;
//! else null, with weight sgn(1 − r)(r + |1 − r|),  r = σ_t/σ̂
//! ```
//!
//! Unbiased for every σ̂ that is positive wherever σ_t is. For `r ≤ 1` it is `woodcock`; beyond,
//! weights are negative and grow as 2r − 1. It is the non-terminating `single` with albedo 1, whose
//! code and moments it shares.
//!
//! Source: M. Galtier et al., *Integral formulation of null-collision Monte Carlo algorithms*,
//! Journal of Quantitative Spectroscopy and Radiative Transfer 125 (2013); L. W. G. Morgan,
//! D. Kotlyar, *Weighted-delta-tracking for Monte Carlo particle transport*, Annals of Nuclear
//! Energy 85 (2015).

use fearless_simd::Level;

use crate::catalogue::Settings;
use crate::estimators::packet::{self, Request};
use crate::estimators::rules::Single;
use crate::estimators::walkers::{self, Walkers};
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup, walk};
use crate::media::Extinction;
use crate::problems::Transmittance;
use crate::rng::Stream;
use crate::theory::Prediction;

const RULE: Single = Single::NonTerminating { albedo: 1.0 };

/// Weighted delta tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct WeightedDelta;

impl Estimator<Transmittance> for WeightedDelta {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const KEEPS_BOOKS: bool = true;
    const IN_PACKETS: bool = true;
    const ORDER_FREE: bool = true;

    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.require_coverage()
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        setup.product(&RULE).predict()
    }

    #[inline(always)]
    fn draw<M: Extinction>(
        &self,
        setup: &Setup<Transmittance>,
        medium: &M,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        walk::product(setup, &RULE, medium, rng)
    }

    fn walkers<'a>(
        &'a self,
        setup: &'a Setup<Transmittance>,
        request: walkers::Request<'a>,
    ) -> Option<Box<dyn Walkers + 'a>> {
        walkers::product(setup, RULE, request)
    }

    fn draw_packets<'a, M: Extinction>(
        &self,
        level: Level,
        setup: &Setup<Transmittance>,
        medium: &M,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::product(level, setup, &RULE, medium, request)
    }
}

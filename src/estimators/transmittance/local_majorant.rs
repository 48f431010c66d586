//! Local-majorant Woodcock tracking: a walk that starts afresh at every segment boundary.
//!
//! ```text
//! in segment j: fly with the constant σ̄ⱼ; beyond its end, go to the boundary and start again
//! ```
//!
//! The exponential law forgets how far a flight has come, so the law of the draws and of the
//! lookups is that of `woodcock` with the same piecewise-constant σ̂, which inverts the piecewise
//! optical depth instead. Only the random numbers differ, one more per boundary crossed.
//!
//! Unbiased for `σ̄ⱼ ≥ σ_t` in every segment j; draws are 0 or 1. Moments and cost are those of
//! `woodcock`.
//!
//! Source: Y. Yue, K. Iwasaki, B.-Y. Chen, Y. Dobashi, T. Nishita, *Unbiased, adaptive stochastic
//! sampling for rendering inhomogeneous participating media*, ACM Transactions on Graphics 29
//! (2010).

use super::woodcock::{ZERO_OR_ONE, zero_or_one};
use crate::catalogue::Settings;
use crate::estimators::rules::Null;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Extinction;
use crate::problems::Transmittance;
use crate::rng::{Stream, exponential, unit};
use crate::theory::Prediction;

/// Local-majorant tracking; a piecewise-constant σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct LocalMajorant;

impl Estimator<Transmittance> for LocalMajorant {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const SKIPS: bool = true;

    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.require_plain_unit(ZERO_OR_ONE)?;
        if !setup.sampling.is_steps() {
            return Err(Refusal::mismatch("a piecewise-constant σ̂", "σ̂ has a slope"));
        }
        setup.require_ratio_at_most(1.0, "σ̄ ≥ σ_t in every segment")
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        // It takes one more at each boundary that it crosses.
        let prediction = setup.product(&Null).predict();
        zero_or_one(Prediction { random_numbers: None, ..prediction })
    }

    fn draw<M: Extinction>(
        &self,
        setup: &Setup<Transmittance>,
        medium: &M,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let mut lookups = 0;
        for (ends, majorant) in setup.sampling.segments() {
            let mut t = ends[0];
            loop {
                t += exponential(rng) / majorant;
                // A segment without extinction has an infinite flight, or 0/0 for a draw of 0.
                if t.is_nan() || t >= ends[1] {
                    break;
                }
                lookups += 1;
                if unit(rng) < medium.extinction(t) / majorant {
                    return Draw::free([0.0], lookups);
                }
            }
        }
        Draw::free([setup.control_transmittance], lookups)
    }
}

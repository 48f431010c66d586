//! Local-majorant Woodcock tracking: a walk that starts afresh at every segment boundary.
//!
//! Unbiased for: a σ̂ ≥ σ_t that is constant in pieces; refused elsewhere.
//!
//! ```text
//! in segment j: fly with the constant σ̄ⱼ; beyond its end, go to the boundary and start again
//! ```
//!
//! The exponential law forgets how far a flight has come, so the law of the draws and of the
//! lookups is that of `woodcock` with the same piecewise-constant σ̂, which inverts the piecewise
//! optical depth instead. Only the random numbers differ: a boundary that is crossed takes those of a step
//! more. Segments without extinction are left out.
//!
//! Draws are 0 or 1. Moments and cost are those of
//! `woodcock`.
//!
//! Source: Y. Yue, K. Iwasaki, B.-Y. Chen, Y. Dobashi, T. Nishita, *Unbiased, adaptive stochastic
//! sampling for rendering inhomogeneous participating media*, ACM Transactions on Graphics 29
//! (2010).

use fearless_simd::Level;

use super::woodcock::{ZERO_OR_ONE, zero_or_one};
use crate::kernels::packet::{self, Request};
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::Transmittance;
use theory::rules::Null;

/// Local-majorant tracking; a piecewise-constant σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct LocalMajorant;

impl Estimator<Transmittance> for LocalMajorant {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);
    const SKIPS: bool = true;
    const IN_PACKETS: bool = true;

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.require_plain_unit(ZERO_OR_ONE)?;
        if !setup.sampling.is_steps() {
            return Err(Refusal::mismatch("a piecewise-constant σ̂", "σ̂ has a slope"));
        }
        setup.require_ratio_at_most(1.0, "σ̄ ≥ σ_t in every segment")
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        // It takes more at each boundary that it crosses.
        let prediction = setup.product(&Null).predict();
        zero_or_one(Prediction { random_numbers: None, ..prediction })
    }

    #[inline(always)]
    fn draw(&self, setup: &Setup<Transmittance>, medium: &Lookups, rng: &mut Stream) -> Draw {
        let mut lookups = 0;
        // A segment without extinction is left out: there is nothing to collide with.
        for (ends, path) in setup.sampling.stretches() {
            let mut t = ends[0];
            loop {
                let (depth, number) = (-rng.ln_uniform(), rng.uniform());
                t = depth.times_plus(path, t);
                if !t.below(ends[1]) {
                    break;
                }
                lookups += 1;
                if number < medium.extinction(t) * path {
                    return Draw::free([0.0], lookups);
                }
            }
        }
        Draw::free([setup.control_transmittance], lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<Transmittance>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::majorants(level, setup, medium, request)
    }
}

//! Residual ratio tracking: ratio tracking of what a constant control leaves over.
//!
//! ```text
//! X = T_c ∏ᵢ (1 − (σ_t(tᵢ) − σ_c)/σ̂(tᵢ)),  T_c = e^{−σ_c ℓ}
//! ```
//!
//! Unbiased for every σ̂ that is positive wherever the residual is not zero, of either sign. The
//! control must be constant (default: the mean of σ_t, the best constant by section 3.4 of
//! Szirmay-Kalos et al. 2017); with any other control the algorithm is `double`, whose code it
//! shares.
//!
//! ```text
//! J_k = ∫ σ̂ r^k,  r = (σ_t − σ_c)/σ̂,  lookups Poisson(∫σ̂)
//! ```
//!
//! Source: J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating Attenuation in
//! Participating Media*, ACM Transactions on Graphics 33 (2014), section 4.

use fearless_simd::Level;

use super::double::{predict_weighted, unbiased_where_covered};
use crate::catalogue::Settings;
use crate::estimators::packet::{self, Request};
use crate::estimators::rules::Weight;
use crate::estimators::walkers::{self, Walkers};
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup, controls, walk};
use crate::media::{Control, Extinction};
use crate::problems::Transmittance;
use crate::rng::Stream;
use crate::theory::Prediction;

/// Residual ratio tracking; σ̂ and a constant control are its inputs.
#[derive(Debug, Clone)]
pub struct ResidualRatio;

impl Estimator<Transmittance> for ResidualRatio {
    const INPUTS: Inputs = Inputs::BOTH;
    const KEEPS_BOOKS: bool = true;
    const IN_PACKETS: bool = true;
    const ORDER_FREE: bool = true;

    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    fn without_control() -> Option<&'static str> {
        Some("ratio")
    }

    fn default_control() -> Option<Box<dyn controls::Recipe>> {
        Some(Box::new(controls::mean::Mean))
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        let constant = match &setup.control {
            Control::None => true,
            Control::Pieces(pieces) => pieces.single_value().is_some(),
            Control::Field(_) => false,
        };
        if !constant {
            let found = "the control varies (write `double` for that)";
            return Err(Refusal::mismatch("a constant control", found));
        }
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

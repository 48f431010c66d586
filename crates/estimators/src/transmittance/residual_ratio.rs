//! Residual ratio tracking: ratio tracking of the residual beside a constant control.
//!
//! Unbiased for: every σ̂ > 0 where the residual is not 0.
//!
//! ```text
//! X = T_c ∏ᵢ (1 − (σ_t(tᵢ) − σ_c)/σ̂(tᵢ)),  T_c = e^{−σ_c ℓ}
//! ```
//!
//! The residual may have either sign. The
//! control must be constant (default: the mean of σ_t, the best constant by section 3.4 of
//! Szirmay-Kalos et al. 2017); with any other control the algorithm is `double`, and
//! both have the same code.
//!
//! ```text
//! J_k = ∫ σ̂ r^k,  r = (σ_t − σ_c)/σ̂,  lookups Poisson(∫σ̂)
//! ```
//!
//! Source: J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating Attenuation in
//! Participating Media*, ACM Transactions on Graphics 33 (2014), section 4.
//!
//! ```toml
//! title = "An example of residual-ratio"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! control = 0.4
//! estimators = ["residual-ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::double::{predict_weighted, unbiased_where_covered};
use crate::recipes::controls;
use crate::{Estimator, Inputs, Refusal, Setup, Traits, product_draws};
use media::Control;
use theory::Prediction;
use theory::collisions::Collisions;
use theory::collisions::rules::Weight;
use theory::problems::Transmittance;

/// Residual ratio tracking; σ̂ and a constant control are its inputs.
#[derive(Debug, Clone)]
pub struct ResidualRatio;

impl Estimator<Transmittance> for ResidualRatio {
    const INPUTS: Inputs = Inputs::BOTH;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits {
            without_control: Some("ratio"),
            default_control: Some(Box::new(controls::mean::Mean)),
            collisions: Some(Collisions::Weight),
            ..Traits::product(Self::INPUTS)
        }
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        let constant = match &setup.fields.control {
            Control::None => true,
            Control::Pieces(pieces) => pieces.single_value().is_some(),
            Control::Field(_) => false,
        };
        if !constant {
            let actual = "the control varies (write `double` for that)";
            return Err(Refusal::mismatch("a constant control", actual));
        }
        unbiased_where_covered(setup)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        predict_weighted(setup)
    }

    product_draws!(self => Weight);
}

//! Ratio tracking: multiply, at each tentative collision, by the share of null collisions.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0.
//!
//! ```text
//! X = ∏ᵢ (1 − σ_t(tᵢ)/σ̂(tᵢ)),  tᵢ a Poisson process of rate σ̂ on [0, ℓ]
//! ```
//!
//! Where `σ̂ < σ_t` the factor is negative
//! and the variance grows; where `σ̂ ≥ σ_t` throughout, X lies in [0, 1]. It is `double` without a
//! control, and shares its code: the same random numbers make the same draws.
//!
//! ```text
//! J_k = ∫ σ̂ r^k,  r = σ_t/σ̂,  lookups Poisson(∫σ̂)
//! ```
//!
//! Source: J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating Attenuation in
//! Participating Media*, ACM Transactions on Graphics 33 (2014), section 3.
//!
//! ```toml
//! title = "An example of ratio"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::double::{predict_weighted, unbiased_where_covered};
use crate::{Estimator, Inputs, Refusal, Setup, Traits, product_draws};
use theory::Prediction;
use theory::collisions::Collisions;
use theory::collisions::rules::Weight;
use theory::problems::Transmittance;

/// Ratio tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Ratio;

impl Estimator<Transmittance> for Ratio {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits { collisions: Some(Collisions::Weight), ..Traits::product(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        unbiased_where_covered(setup)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        predict_weighted(setup)
    }

    product_draws!(self => Weight);
}

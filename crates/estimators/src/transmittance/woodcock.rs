//! Woodcock (delta) tracking: fly through a majorant and stop at the first real collision.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! X = 1 if every tentative collision is null, each with probability 1 − σ_t(tᵢ)/σ̄(tᵢ); else 0
//! ```
//!
//! Draws are 0 or 1. It is the terminating single particle model for `0 ≤ r ≤ 1`. Refused where σ̂ is no majorant:
//! there the probability of a null collision is negative.
//!
//! ```text
//! J_k = τ for every k,  Var X = T(1 − T),  E[lookups] = ∫ σ̄ T dt
//! ```
//!
//! Source: E. R. Woodcock, T. Murphy, P. Hemmings, T. Longworth, *Techniques used in the GEM code
//! for Monte Carlo neutronics calculations in reactors and other systems of complex geometry*,
//! ANL-7050 (1965); W. A. Coleman, *Mathematical verification of a certain Monte Carlo sampling
//! technique*, Nuclear Science and Engineering 32 (1968).
//!
//! ```toml
//! title = "An example of woodcock"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! estimators = ["woodcock"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::{Estimator, Inputs, Refusal, Setup, Traits, product_draws};
use theory::Prediction;
use theory::collisions::rules::Null;
use theory::problems::Transmittance;
use theory::ray::atoms::zero_or_one;

/// Woodcock tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Woodcock;

/// Requirement of estimators with draws of 0 or 1.
pub const ZERO_OR_ONE: &str = "τ ≤ 300 (draws are 0 or 1, and a 1 is never seen)";

impl Estimator<Transmittance> for Woodcock {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits::product(Self::INPUTS)
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.fields.require_plain_unit(ZERO_OR_ONE)?;
        setup.residual().require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        zero_or_one(setup.product(&Null).predict())
    }

    product_draws!(self => Null);
}

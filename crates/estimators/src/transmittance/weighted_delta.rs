//! Weighted delta tracking: a σ̂ that is no majorant, with signed weights.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0.
//!
//! ```text
//! real with probability σ_t/(σ_t + |σ̂ − σ_t|), which ends the walk with X = 0;
//! else null, with weight sgn(1 − r)(r + |1 − r|),  r = σ_t/σ̂
//! ```
//!
//! For `r ≤ 1` it is `woodcock`. Beyond, weights are negative and grow as 2r − 1. It is the non-terminating
//! `single` with albedo 1, and uses its code and moments.
//!
//! Source: M. Galtier et al., *Integral formulation of null-collision Monte Carlo algorithms*,
//! Journal of Quantitative Spectroscopy and Radiative Transfer 125 (2013); L. W. G. Morgan,
//! D. Kotlyar, *Weighted-delta-tracking for Monte Carlo particle transport*, Annals of Nuclear
//! Energy 85 (2015).
//!
//! ```toml
//! title = "An example of weighted-delta"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! estimators = ["weighted-delta"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::{Estimator, Inputs, Refusal, Setup, Traits, product_draws};
use theory::Prediction;
use theory::collisions::Collisions;
use theory::collisions::rules::Single;
use theory::problems::Transmittance;

const RULE: Single = Single::NonTerminating { albedo: 1.0 };

/// Weighted delta tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct WeightedDelta;

impl Estimator<Transmittance> for WeightedDelta {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        let collisions = Some(Collisions::Single(RULE));
        Traits { collisions, ..Traits::product(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.residual().require_coverage()?;
        setup.fields.require_finite_weights(&RULE)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        setup.product(&RULE).predict()
    }

    product_draws!(self => RULE);
}

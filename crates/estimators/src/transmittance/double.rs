//! The double particle model: both particles are kept, the transmitted one with weight 1 − r.
//!
//! Unbiased for: every σ̂ > 0 where the residual is not 0.
//!
//! ```text
//! X = T_c ∏ᵢ (1 − r(tᵢ)),  r = (σ_t − σ_c)/σ̂,  tᵢ a Poisson process of rate σ̂
//! ```
//!
//! Weights are negative below the density (r > 1), and above 1 with negative extinction (σ_c > σ_t, r < 0). Without a
//! control it is `ratio`; with a constant one, `residual-ratio`.
//!
//! ```text
//! J_k = ∫ σ̂ r^k,  w = σ_residual r (Eq. 17),  Var X = T²(e^{∫w} − 1) (Eq. 16)
//! lookups Poisson(∫σ̂);  constant r: X = T_c (1 − r)^N, N Poisson(∫σ̂)
//! ```
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! Eq. 8, section 4.2.
//!
//! ```toml
//! title = "An example of double"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 0.5
//! control = "mean"
//! estimators = ["double"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::{Estimator, Inputs, Refusal, Setup, Traits, product_draws};
use theory::Prediction;
use theory::collisions::Collisions;
use theory::collisions::rules::Weight;
use theory::problems::Transmittance;
use theory::ray::atoms;

/// The double particle model; σ̂ and any control are its inputs.
#[derive(Debug, Clone)]
pub struct DoubleParticle;

/// Checks that σ̂ covers every place where the residual is not zero, and that weights stay finite.
///
/// # Errors
///
/// The interval that σ̂ leaves out, or the factor by which a collision may multiply a weight.
pub fn unbiased_where_covered(setup: &Setup<Transmittance>) -> Result<(), Refusal> {
    setup.residual().require_coverage()?;
    setup.fields.require_finite_weights(&Weight)
}

/// The moments on this page's head, and the distribution where r is constant.
pub fn predict_weighted(setup: &Setup<Transmittance>) -> Prediction {
    let prediction = setup.product(&Weight).predict();
    let distribution = setup.residual().constant_ratio().and_then(|ratio| {
        let mean = prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean);
        atoms::powers(setup.fields.control_transmittance(), 1.0 - ratio, mean)
    });
    Prediction { distribution, ..prediction }
}

impl Estimator<Transmittance> for DoubleParticle {
    const INPUTS: Inputs = Inputs::BOTH;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        let (without_control, collisions) = (Some("ratio"), Some(Collisions::Weight));
        Traits { without_control, collisions, ..Traits::product(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        unbiased_where_covered(setup)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        predict_weighted(setup)
    }

    product_draws!(self => Weight);
}

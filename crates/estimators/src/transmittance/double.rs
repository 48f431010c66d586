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

use crate::{Estimator, Inputs, Refusal, Setup, product_draws};
use theory::collisions::rules::Weight;
use theory::prediction::count::poisson;
use theory::problems::Transmittance;
use theory::{Distribution, Prediction};

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
    let distribution = setup.residual().constant_ratio().map(|ratio| {
        let mean = prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean);
        Distribution::Atoms(powers(setup.fields.control_transmittance(), 1.0 - ratio, mean))
    });
    Prediction { distribution, ..prediction }
}

/// `T_c f^n` with its Poisson probability, for n up to where the tail is below 1e-12.
fn powers(scale: f64, factor: f64, mean: f64) -> Vec<(f64, f64)> {
    let most = (mean + 12.0 * mean.sqrt() + 30.0).min(1e4);
    let mut atoms: Vec<(f64, f64)> = Vec::new();
    let mut value = scale;
    for n in (0..u32::MAX).take_while(|&n| f64::from(n) <= most) {
        let probability = poisson(n, mean);
        match atoms.iter_mut().find(|atom| atom.0 == value) {
            // A factor of 0 or ±1 puts many n on one atom.
            Some(atom) => atom.1 += probability,
            None => atoms.push((value, probability)),
        }
        value *= factor;
    }
    atoms
}

impl Estimator<Transmittance> for DoubleParticle {
    const INPUTS: Inputs = Inputs::BOTH;
    const PLAIN: Option<Self> = Some(Self);

    fn without_control() -> Option<&'static str> {
        Some("ratio")
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        unbiased_where_covered(setup)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        predict_weighted(setup)
    }

    product_draws!(self => Weight);
}

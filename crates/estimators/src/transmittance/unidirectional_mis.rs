//! Unidirectional MIS: next-flight and the flight itself, weighted by the balance heuristic.
//!
//! Unbiased for: every constant σ̂ > 0.
//!
//! ```text
//! F(x) = u(x)(1 + 1[x' ≥ ℓ]) + 1[x' < ℓ] ρ(x') F(x'),  u = v/(1 + v),  v(x) = e^{−σ̄(ℓ−x)}
//! X = F(0),  ρ = 1 − σ_t/σ̄,  x' = x + flight of rate σ̄
//! ```
//!
//! Below the density the weights change sign.
//!
//! ```text
//! E[F^k] from the Volterra equations of theory::ray::volterra with
//! g_k = v(2u)^k + (1 − v)u^k + Σ_{0<j<k} C(k, j) u^{k−j} A_j;  lookups Poisson(σ̄ ℓ)
//! ```
//!
//! Source: I. Georgiev, Z. Misso, T. Hachisuka, D. Nowrouzezahrai, J. Křivánek, W. Jarosz,
//! *Integral formulations of volumetric transmittance*, ACM Transactions on Graphics 38 (2019).
//!
//! ```toml
//! title = "An example of unidirectional-mis"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! estimators = ["unidirectional-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::scoring::Share;
use crate::{Setup, scored};
use numeric::Lane;
use theory::prediction::raw::binomial;
use theory::problems::Transmittance;
use theory::ray::volterra::{ORDERS, ScoreMoments, power};

/// The unidirectional-MIS estimator; a constant σ̂ is its only input.
#[derive(Debug, Clone, Copy)]
pub struct UnidirectionalMis;

impl ScoreMoments for UnidirectionalMis {
    fn moment(&self, k: usize, v: f64, lower: &[f64; ORDERS]) -> f64 {
        let u = v / (1.0 + v);
        let mixed = (1..k).map(|j| binomial(k, j) * power(u, k - j) * lower[j - 1]);
        v * power(2.0 * u, k) + (1.0 - v) * power(u, k) + mixed.sum::<f64>()
    }
}

impl Share for UnidirectionalMis {
    const FLIGHT_SCORES: bool = true;

    #[inline(always)]
    fn of<L: Lane>(&self, left: L) -> L {
        let v = Lane::exp(-left);
        v / (v + 1.0)
    }
}

scored!(UnidirectionalMis);

//! Next-flight estimation: at every collision, add the probability to fly straight to the end.
//!
//! Unbiased for: every constant σ̂ > 0.
//!
//! ```text
//! F(x) = v(x) + 1[x' < ℓ] ρ(x') F(x'),  v(x) = e^{−σ̄(ℓ−x)},  ρ = 1 − σ_t/σ̄
//! X = F(0),  x' = x + flight of rate σ̄
//! ```
//!
//! Below the density the weights change sign.
//!
//! ```text
//! E[F^k] from the Volterra equations of theory::ray::volterra with g_k = Σ_{j<k} C(k, j) v^{k−j} A_j
//! lookups Poisson(σ̄ ℓ)
//! ```
//!
//! Source: S. N. Cramer, *Application of the fictitious scattering radiation transport model for
//! deep-penetration Monte Carlo calculations*, Nuclear Science and Engineering 65 (1978);
//! I. Georgiev et al., *Integral formulations of volumetric transmittance*, ACM Transactions on
//! Graphics 38 (2019).
//!
//! ```toml
//! title = "An example of next-flight"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! estimators = ["next-flight"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::scoring::Share;
use crate::{Setup, scored};
use numeric::Lane;
use theory::prediction::raw::binomial;
use theory::problems::Transmittance;
use theory::ray::volterra::{ORDERS, ScoreMoments, power};

/// The next-flight estimator; a constant σ̂ is its only input.
#[derive(Debug, Clone, Copy)]
pub struct NextFlight;

impl ScoreMoments for NextFlight {
    fn moment(&self, k: usize, v: f64, lower: &[f64; ORDERS]) -> f64 {
        let mixed = (1..k).map(|j| binomial(k, j) * power(v, k - j) * lower[j - 1]);
        power(v, k) + mixed.sum::<f64>()
    }
}

impl Share for NextFlight {
    const FLIGHT_SCORES: bool = false;

    #[inline(always)]
    fn of<L: Lane>(&self, left: L) -> L {
        Lane::exp(-left)
    }
}

scored!(NextFlight);

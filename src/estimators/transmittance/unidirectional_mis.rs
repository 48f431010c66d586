//! Unidirectional MIS: next-flight and the flight itself, weighted by the balance heuristic.
//!
//! ```text
//! F(x) = u(x)(1 + 1[x' ≥ ℓ]) + 1[x' < ℓ] ρ(x') F(x'),  u = v/(1 + v),  v(x) = e^{−σ̄(ℓ−x)}
//! X = F(0),  ρ = 1 − σ_t/σ̄,  x' = x + flight of rate σ̄
//! ```
//!
//! Unbiased for every constant `σ̄ > 0`; below the density the weights change sign.
//!
//! ```text
//! E[F^k] from the Volterra equations of theory::volterra with
//! g_k = v(2u)^k + (1 − v)u^k + Σ_{0<j<k} C(k, j) u^{k−j} A_j;  lookups Poisson(σ̄ ℓ)
//! ```
//!
//! Source: I. Georgiev, Z. Misso, T. Hachisuka, D. Nowrouzezahrai, J. Křivánek, W. Jarosz,
//! *Integral formulations of volumetric transmittance*, ACM Transactions on Graphics 38 (2019).

use crate::catalogue::Settings;
use crate::estimators::rules::Weight;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Extinction;
use crate::numeric::Lane;
use crate::problems::Transmittance;
use crate::rng::{Stream, exponential};
use crate::theory::Prediction;
use crate::theory::volterra::{self, ORDERS, Source, binomial, power};

/// The unidirectional-MIS estimator; a constant σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct UnidirectionalMis;

impl Source for UnidirectionalMis {
    fn moment(&self, k: usize, v: f64, lower: &[f64; ORDERS]) -> f64 {
        let u = v / (1.0 + v);
        let mixed = (1..k).map(|j| binomial(k, j) * power(u, k - j) * lower[j - 1]);
        v * power(2.0 * u, k) + (1.0 - v) * power(u, k) + mixed.sum::<f64>()
    }
}

impl Estimator<Transmittance> for UnidirectionalMis {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(_: &Settings) -> Option<Self> {
        Some(Self)
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.require_plain_unit("τ ≤ 300 (its draws are sums of terms of every size)")?;
        setup.require_constant_sampling()?;
        setup.require_finite_weights(&Weight)
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        volterra::predict(&setup.mesh, setup.sampling.single_value().unwrap_or(0.0), self)
    }

    fn draw<M: Extinction>(
        &self,
        setup: &Setup<Transmittance>,
        medium: &M,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let end = setup.mesh.support().to;
        let mut cursor = setup.sampling.begin();
        let mut weight = 1.0;
        let mut lookups = 0;
        let mut score = 0.0;
        let share = |sampling: f64, t: f64| {
            let v = Lane::exp(-sampling * (end - t));
            v / (1.0 + v)
        };
        let mut here = share(setup.sampling.value(cursor.t), cursor.t);
        while let Some(sampling) = setup.sampling.fly(&mut cursor, exponential(rng)) {
            score += weight * here;
            weight *= 1.0 - medium.extinction(cursor.t) / sampling;
            lookups += 1;
            here = share(sampling, cursor.t);
        }
        Draw::free([(score + 2.0 * weight * here) * setup.control_transmittance], lookups)
    }
}

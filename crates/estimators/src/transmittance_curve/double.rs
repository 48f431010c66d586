//! The double particle model's continuous transmittance: one walk, many distances.
//!
//! Unbiased for: every σ̂ > 0 where the residual is not 0, at every distance.
//!
//! ```text
//! T̂(s) = T_c(s) ∏_{tᵢ < s} (1 − r(tᵢ)),  r = (σ_t − σ_c)/σ̂,  tᵢ a Poisson process of rate σ̂
//! ```
//!
//! Unbiased at every s for every σ̂ that is positive wherever the residual is not zero. Between
//! collisions T̂ follows the control's own decay. Values at two distances of one walk are
//! correlated:
//!
//! ```text
//! Var T̂(s) = T(s)² expm1(J₂(s)),  Cov[T̂(s₁), T̂(s₂)] = T(s₁) T(s₂) expm1(J₂(s₁)),  s₁ ≤ s₂
//! lookups Poisson(∫σ̂)
//! ```
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! sections 4.2–4.3, Figures 5 and 8.

use fearless_simd::Level;

use super::packet;
use super::ray_view::{self, RayView};
use crate::kernels::packet::Request;
use crate::kernels::walk::Invariant;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::{Extinction, Lookups, Medium};
use numeric::rng::{Address, Stream, exponential};
use theory::problems::TransmittanceCurve;
use theory::problems::transmittance_curve::{MOST, Values};
use theory::rules::Weight;
use theory::{Prediction, curve};

/// The double particle model; σ̂ and any control are its inputs.
#[derive(Debug, Clone)]
pub struct DoubleCurve;

/// One walk: its tentative collisions `(t, σ_t(t), weight after it)`.
pub fn walk(setup: &Setup<TransmittanceCurve>, medium: &Medium, rng: &mut Stream) -> Vec<[f64; 3]> {
    let mut cursor = setup.sampling.begin();
    let mut weight = 1.0;
    let mut collisions = Vec::new();
    while let Some(sampling) = setup.sampling.fly(&mut cursor, exponential(rng)) {
        let extinction = medium.extinction(cursor.t);
        weight *= 1.0 - (extinction - setup.control.extinction(cursor.t)) / sampling;
        collisions.push([cursor.t, extinction, weight]);
    }
    collisions
}

impl Estimator<TransmittanceCurve> for DoubleCurve {
    const INPUTS: Inputs = Inputs::BOTH;
    const PLAIN: Option<Self> = Some(Self);
    const SKIPS: bool = true;
    const HAS_INVARIANT: bool = true;
    const IN_PACKETS: bool = true;

    fn domain(&self, setup: &Setup<TransmittanceCurve>) -> Result<(), Refusal> {
        setup.require_coverage()?;
        setup.require_finite_weights(&Weight)
    }

    fn predict(&self, setup: &Setup<TransmittanceCurve>) -> Prediction {
        curve::predict(&setup.product(&Weight), setup.problem.ascending())
    }

    fn ray_view(&self, setup: &Setup<TransmittanceCurve>, address: Address) -> Option<RayView> {
        Some(ray_view::ray_view(setup, address))
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<TransmittanceCurve>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let distances = setup.problem.ascending();
        let mut values = Values { at: [0.0; MOST], count: distances.len() };
        let mut next = 0;
        let mut pass = |until: f64, weight: f64| {
            while next < distances.len() && distances[next] <= until {
                values.at[next] = weight * setup.control_curve[next];
                next += 1;
            }
        };
        let mut cursor = setup.sampling.begin();
        let mut weight = 1.0;
        let mut invariant = Invariant::open(weight);
        let mut lookups = 0;
        while let Some(sampling) = setup.sampling.fly(&mut cursor, -rng.ln_uniform()) {
            pass(cursor.t, weight);
            let residual = medium.extinction(cursor.t) - setup.control.extinction(cursor.t);
            let due = 1.0 - residual * (1.0 / sampling);
            invariant.take(weight, due);
            weight *= due;
            lookups += 1;
        }
        pass(f64::INFINITY, weight);
        Draw { value: values, lookups, defect: invariant.defect(weight) }
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<TransmittanceCurve>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        packet::curve(level, setup, medium, request)
    }
}

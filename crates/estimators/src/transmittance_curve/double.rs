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
//!
//! ```toml
//! title = "An example of double"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! distances = 4
//! sampling = 1.2
//! estimators = ["double"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::ray_view::{self, RayView};
use crate::transmittance::product::{Invariant, Subtracted};
use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::Medium;
use media::sampling::BothWays;
use numeric::rng::{Address, Random, Stream, exponential};
use numeric::{Lane, kept};
use theory::Prediction;
use theory::collisions::rules::Weight;
use theory::problems::TransmittanceCurve;
use theory::problems::transmittance::MAX_DISTANCES;
use theory::ray::curve;

/// The double particle model; σ̂ and any control are its inputs.
#[derive(Debug, Clone)]
pub struct DoubleCurve;

/// Tentative collisions of one walk: `(t, σ_t(t), weight after it)`.
pub fn walk(setup: &Setup<TransmittanceCurve>, medium: &Medium, rng: &mut Stream) -> Vec<[f64; 3]> {
    let mut cursor = setup.fields.sampling.begin();
    let mut weight = 1.0;
    let mut collisions = Vec::new();
    while let Some(sampling) = cursor.fly(exponential(rng)) {
        let t = cursor.t();
        let extinction = medium.extinction(t);
        weight *= 1.0 - (extinction - setup.fields.control.extinction(t)) / sampling;
        collisions.push([t, extinction, weight]);
    }
    collisions
}

impl Estimator<TransmittanceCurve> for DoubleCurve {
    const INPUTS: Inputs = Inputs::BOTH;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits::product(Self::INPUTS)
    }

    fn domain(&self, setup: &Setup<TransmittanceCurve>) -> Result<(), Refusal> {
        setup.residual().require_coverage()?;
        setup.fields.require_finite_weights(&Weight)
    }

    fn predict(&self, setup: &Setup<TransmittanceCurve>) -> Prediction {
        curve::predict(&setup.product(&Weight), setup.problem.ascending())
    }

    fn ray_view(&self, setup: &Setup<TransmittanceCurve>, address: Address) -> Option<RayView> {
        Some(ray_view::ray_view(setup, address))
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<TransmittanceCurve>, request: Request) {
        walks::fill(&Curve::new(setup), kernel, setup, request);
    }
}

kept! {
    /// A walk along the ray of a curve.
    ///
    /// A collision at t changes the weight at all distances beyond it. Each distance keeps the weight at the last
    /// collision before it.
    ///
    /// ```text
    /// w ← w (1 − r(t));  w_k ← w  where t < s_k;  at the end T̂(s_k) = T_c(s_k) w_k
    /// ```
    pub struct Weights<L> {
        weight: L,
        ahead: [L; MAX_DISTANCES],
        invariant: Invariant<L>,
    }
}

/// The walk of a curve.
#[derive(Clone, Copy)]
pub struct Curve<'a> {
    control: Subtracted<'a>,
    distances: &'a [f64],
    /// T_c at the distances.
    units: &'a [f64],
}

impl<'a> Curve<'a> {
    /// The walk on a setup.
    #[inline(always)]
    pub fn new(setup: &'a Setup<TransmittanceCurve>) -> Self {
        let distances = setup.problem.ascending();
        let control = Subtracted::new(&setup.fields.control);
        Self { control, distances, units: &setup.fields.control_curve }
    }
}

impl Walk for Curve<'_> {
    type State<L: Lane> = Weights<L>;

    const DECIDES: bool = false;
    const HAS_DEFECT: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Weights<L> {
        Weights { weight: one, ahead: [one; MAX_DISTANCES], invariant: Invariant::open(one) }
    }

    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        weights: &mut Weights<L>,
        which: L::Mask,
        one: L,
        _: &mut impl Random<L>,
    ) {
        let Weights { weight, ahead, invariant } = weights;
        *weight = L::select(which, one, *weight).sealed();
        let mut fresh = *invariant;
        fresh.restart(which);
        (invariant.taken, invariant.scale) = (fresh.taken.sealed(), fresh.scale.sealed());
        for ahead in &mut ahead[..self.distances.len()] {
            *ahead = L::select(which, one, *ahead).sealed();
        }
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        weights: &mut Weights<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        let TentativeCollision { inside, t, mean_free_path, extinction, .. } = *extinctions;
        let residual = extinction - self.control.extinction(t);
        let due = t.each(1.0) - residual * mean_free_path;
        let Weights { weight, ahead, invariant } = weights;
        // The whole state is in memory, because `ahead` is indexed.
        let (mut taken, before) = (*invariant, *weight);
        taken.take_where(inside, before, due);
        (invariant.taken, invariant.scale) = (taken.taken.sealed(), taken.scale.sealed());
        let after = L::select(inside, before * due, before).sealed();
        *weight = after;
        let t = L::select(inside, t, t.each(f64::INFINITY));
        for (number, &distance) in self.distances.iter().enumerate() {
            let is_ahead = t.below(t.each(distance));
            ahead[number] = L::select(is_ahead, after, ahead[number]).sealed();
        }
        inside
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.distances.len()
    }

    #[inline(always)]
    fn value<L: Lane>(&self, weights: &Weights<L>, _: L::Mask, distance: usize) -> L {
        weights.ahead[distance] * self.units[distance]
    }

    #[inline(always)]
    fn defect<L: Lane>(&self, weights: &Weights<L>, _: L) -> L {
        weights.invariant.defect(weights.weight)
    }
}

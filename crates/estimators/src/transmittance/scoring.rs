//! The walk of next-flight estimators: every place scores a share of the probability to fly straight to
//! the end.
//!
//! ```text
//! X = T_c (Σᵢ wᵢ s(tᵢ) [+ w_N s(t_N)]),  i = 0 … N,  wᵢ = ∏ (1 − σ_t(tⱼ)/σ̄), j = 1 … i
//! s a share of v = e^{−σ̄(ℓ − t)},  t₀ = 0,  t₁ … t_N a Poisson process of rate σ̄
//! ```
//!
//! A step takes one random number, that of the flight.

use crate::Setup;
use crate::walks::{Route, TentativeCollision, Walk};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Kept, Lane, kept};
use theory::problems::Transmittance;

/// The score of a place, as one formula for every lane type.
pub trait Share: Copy {
    /// True if the flight that reaches the end scores the share of its starting point again.
    const FLIGHT_SCORES: bool;

    /// The share of v, given the optical depth of σ̄ that remains.
    fn of<L: Lane>(&self, left: L) -> L;
}

kept! {
    /// The weight and the score of a walk.
    pub struct Score<L> {
        weight: L,
        /// The score of the last place.
        last: L,
        /// The score of all places.
        sum: L,
    }
}

impl<L: Lane> Score<L> {
    /// Score at the beginning, with the share there.
    #[inline(always)]
    pub fn open(share: L) -> Self {
        Self { weight: share.each(1.0), last: share, sum: share }
    }

    /// Score after a collision of this ratio `σ_t/σ̄`, with the share there.
    #[must_use]
    #[inline(always)]
    pub fn collided(self, ratio: L, share: L) -> Self {
        let weight = self.weight * ratio.one_minus();
        let last = weight * share;
        Self { weight, last, sum: self.sum + last }
    }

    /// Score of a walk that reaches the end.
    #[inline(always)]
    pub fn total<H: Share>(&self) -> L {
        if H::FLIGHT_SCORES { self.sum + self.last } else { self.sum }
    }
}

/// The walk of a next-flight estimator, through a constant σ̂.
#[derive(Clone, Copy)]
pub struct Scoring<H> {
    share: H,
    /// T_c.
    unit: f64,
    /// The ends of σ̂.
    ends: [f64; 2],
    /// σ̄.
    sampling: f64,
}

impl<H: Share> Scoring<H> {
    /// The walk on a setup.
    #[inline(always)]
    pub fn new(share: H, setup: &Setup<Transmittance>) -> Self {
        let begin = setup.fields.sampling.begin().t();
        Self {
            share,
            unit: setup.fields.control_transmittance(),
            ends: [begin, setup.fields.mesh.support().to],
            sampling: setup.fields.sampling.value(begin),
        }
    }

    #[inline(always)]
    fn share<L: Lane>(&self, t: L) -> L {
        self.share.of((t.each(self.ends[1]) - t) * t.each(self.sampling))
    }
}

impl<H: Share> Walk for Scoring<H> {
    type State<L: Lane> = Score<L>;

    const DECIDES: bool = false;
    const IS_FIXED: bool = true;
    const INLINES_EQ21: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Score<L> {
        Score::open(self.share(one.each(self.ends[0])))
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        score: &mut Score<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        score.set_where(
            extinctions.inside,
            score.collided(extinctions.ratio(), self.share(extinctions.t)),
        );
        extinctions.inside
    }

    #[inline(always)]
    fn value<L: Lane>(&self, score: &Score<L>, _: L::Mask, _: usize) -> L {
        score.total::<H>() * self.unit
    }
}

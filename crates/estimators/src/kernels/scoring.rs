//! The walk of next-flight estimators: each place that it comes to scores a share of the chance to fly
//! straight to the end.
//!
//! ```text
//! X = T_c (Σᵢ wᵢ s(tᵢ) [+ w_N s(t_N)]),  i = 0 … N,  wᵢ = ∏ (1 − σ_t(tⱼ)/σ̄), j = 1 … i
//! s a share of v = e^{−σ̄(ℓ − t)},  t₀ = 0,  t₁ … t_N a Poisson process of rate σ̄
//! ```
//!
//! A step takes one random number, that of the flight.

use super::Draw;
use crate::setup::Setup;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;

/// What a place scores, as one formula for every lane type.
pub trait Share {
    /// Whether the flight that reaches the end scores what the place scored where it began, too.
    const FLIGHT_SCORES: bool;

    /// The share of v, where so much of σ̄'s optical depth is left.
    fn of<L: Lane>(&self, left: L) -> L;
}

/// What a walk carries and has scored.
#[derive(Debug, Clone, Copy)]
pub struct Score<L = f64> {
    /// The weight.
    pub weight: L,
    /// What the last place scored.
    pub last: L,
    /// What all of them scored.
    pub sum: L,
}

impl<L: Lane> Score<L> {
    /// At the beginning, where the share is so large.
    #[inline(always)]
    pub fn open(share: L) -> Self {
        Self { weight: share.each(1.0), last: share, sum: share }
    }

    /// After a collision of this ratio `σ_t/σ̄`, where the share is so large.
    #[must_use]
    #[inline(always)]
    pub fn collided(self, ratio: L, share: L) -> Self {
        let weight = self.weight * (ratio.each(1.0) - ratio);
        let last = weight * share;
        Self { weight, last, sum: self.sum + last }
    }

    /// What a walk has scored that reaches the end from here.
    #[inline(always)]
    pub fn total<S: Share>(self) -> L {
        if S::FLIGHT_SCORES { self.sum + self.last } else { self.sum }
    }
}

/// Walks to the end of the support through a constant σ̂.
#[inline(always)]
pub fn walk<P, S: Share>(setup: &Setup<P>, share: &S, medium: &Lookups, rng: &mut Stream) -> Draw {
    let end = setup.mesh.support().to;
    let mut cursor = setup.sampling.begin();
    let first = (end - cursor.t) * setup.sampling.value(cursor.t);
    let mut score = Score::open(share.of(first));
    let mut lookups = 0;
    while let Some(sampling) = setup.sampling.fly(&mut cursor, -rng.ln_uniform()) {
        lookups += 1;
        let ratio = medium.extinction(cursor.t) * (1.0 / sampling);
        score = score.collided(ratio, share.of((end - cursor.t) * sampling));
    }
    Draw::free([score.total::<S>() * setup.control_transmittance], lookups)
}

//! Effect of collisions on one moment of a walk.
//!
//! The k-th moment U of the score of all that comes later obeys `u = g + K u` in every body, along a flight
//!
//! ```text
//! −dU/ds = σ̂ (g + Q U + S P U − U),   Q = E[W^k; straight on],  S = E[W^k; scattered]
//! ```
//!
//! with P the mean over new directions and W the factor of the weight. Rods solve it by collocation
//! ([`crate::rod::line`]), slabs by adding and doubling ([`crate::slab::layer`]). Where walks never scatter, products keep
//! more digits as integrals of `1 − Q` ([`crate::ray::product`], [`crate::single::segment`]). Walks of several channels have
//! a loss that is constant along the ray, which they keep apart ([`crate::colours::rates`]).

use numeric::Scalar;

/// Collisions at a place, or in a layer in which all are alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kernel<S = f64> {
    /// Rate of tentative collisions, σ̂; across a layer, `∫σ̂`.
    pub rate: f64,
    /// Q, the moment of transmitted particles.
    pub straight: S,
    /// S, the moment of scattered particles.
    pub scattered: S,
    /// g, the score of a collision.
    pub score: f64,
}

impl<S: Scalar> Kernel<S> {
    /// `1 − Q`, the loss of a particle that goes straight on.
    pub fn lost(&self) -> S {
        S::from(1.0) - self.straight
    }

    /// Returns whether the moment along a flight without end is infinite, as collisions take nothing and scatter.
    pub fn is_endless(&self) -> bool {
        self.lost().leading() <= 0.0 && self.scattered.leading() > 0.0
    }
}

impl Kernel {
    /// Rate of scattering, `σ̂ S`.
    pub fn scattering(&self) -> f64 {
        self.rate * self.scattered
    }

    /// Moment behind a collision, given those of a particle that goes straight on and of one that is scattered.
    #[inline]
    pub fn after(&self, on: f64, spread: f64) -> f64 {
        self.straight * on + self.scattered * spread
    }

    /// The kernel in which every collision multiplies the weight by the mark of a series.
    pub fn marked<M: Scalar>(self) -> Kernel<M> {
        let Self { rate, straight, scattered, score } = self;
        let [straight, scattered] = [straight, scattered].map(|x| M::mark() * x);
        Kernel { rate, straight, scattered, score }
    }
}

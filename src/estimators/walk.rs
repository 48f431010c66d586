//! The walk from tentative collision to tentative collision that all product estimators share.
//!
//! ```text
//! X = T_c ∏ W(tᵢ),  tᵢ a Poisson process of rate σ̂ on the support
//! ```
//!
//! It is the algorithm *Transmittance* of Szirmay-Kalos et al. 2017, section 4.2, with the rule at
//! a collision left open. The free flight to the next collision inverts `∫σ̂` exactly.
//!
//! Every draw also keeps its books: at a collision the particle hands over the share that the rule
//! takes from it, and at any time what it still carries and what it handed over is what it began
//! with, to rounding:
//!
//! ```text
//! X(S) + Σᵢ X(tᵢ⁻)(1 − (1 − rᵢ)/qᵢ) = T_c
//! ```

use super::{Draw, Setup};
use crate::media::Extinction;
use crate::rng::{Stream, exponential, unit};
use crate::theory::Rule;

/// Walks to the end of the support or of the particle.
#[inline(always)]
pub fn product<P, M: Extinction, R: Rule>(
    setup: &Setup<P>,
    rule: &R,
    medium: &M,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    let mut cursor = setup.sampling.begin();
    let mut weight = setup.control_transmittance;
    let mut books = Books::open(weight);
    let mut lookups = 0;
    while let Some(sampling) = setup.sampling.fly(&mut cursor, exponential(rng)) {
        let residual = medium.extinction(cursor.t) - setup.control.extinction(cursor.t);
        lookups += 1;
        let ratio = residual / sampling;
        let outcome = rule.outcome(ratio);
        if outcome.survival < 1.0 && unit(rng) >= outcome.survival {
            return Draw { value: [0.0], lookups, defect: books.defect(weight) };
        }
        books.hand_over(weight, ratio, outcome.survival);
        weight *= outcome.weight;
    }
    Draw { value: [weight], lookups, defect: books.defect(weight) }
}

/// What a particle began with, and what it handed over at its collisions.
#[derive(Debug, Clone, Copy)]
pub struct Books {
    begin: f64,
    handed_over: f64,
    turnover: f64,
}

impl Books {
    /// The books of a particle that begins with a weight.
    #[inline(always)]
    #[must_use]
    pub fn open(weight: f64) -> Self {
        Self { begin: weight, handed_over: 0.0, turnover: weight.abs() }
    }

    /// Books the share that a collision takes from a particle that survives it.
    #[inline(always)]
    pub fn hand_over(&mut self, weight: f64, ratio: f64, survival: f64) {
        let share = weight * (1.0 - (1.0 - ratio) / survival);
        self.handed_over += share;
        self.turnover += share.abs();
    }

    /// What is missing at the end, relative to all that was booked; rounding in a correct walk.
    #[inline(always)]
    #[must_use]
    pub fn defect(&self, weight: f64) -> f64 {
        (weight + self.handed_over - self.begin).abs() / self.turnover
    }
}

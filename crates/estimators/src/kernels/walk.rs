//! The walk from tentative collision to tentative collision that all product estimators share.
//!
//! ```text
//! X = T_c ∏ W(tᵢ),  tᵢ a Poisson process of rate σ̂ on the support
//! ```
//!
//! It is the algorithm *Transmittance* of Szirmay-Kalos et al. 2017, section 4.2, with the rule at
//! a collision left open. The free flight to the next collision inverts `∫σ̂` exactly. A step takes
//! its random numbers at once: one for the flight and, where the rule decides by chance, one for the
//! decision, used or not, so that a stream's numbers do not depend on where the walk has come.
//!
//! Every draw also keeps an invariant: at a collision the rule takes a share from the particle, and at any time what it still
//! carries and what was taken from it is what it began with, to rounding:
//!
//! ```text
//! X(S) + Σᵢ X(tᵢ⁻)(1 − (1 − rᵢ)/qᵢ) = T_c
//! ```

use super::Draw;
use crate::setup::Setup;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::rules::{Collision, Met};

/// Walks to the end of the support or of the particle.
#[inline(always)]
pub fn product<P, R: Collision>(
    setup: &Setup<P>,
    rule: &R,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw {
    let mut cursor = setup.sampling.begin();
    let mut weight = setup.control_transmittance;
    let mut invariant = Invariant::open(weight);
    let mut lookups = 0;
    loop {
        let depth = -rng.ln_uniform();
        let number = if R::DECIDES { rng.uniform() } else { 0.0 };
        let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else { break };
        let residual = medium.extinction(cursor.t) - setup.control.extinction(cursor.t);
        lookups += 1;
        let met = Met { residual, sampling, mean_free_path: 1.0 / sampling };
        let (ratio, outcome) = (met.ratio(), rule.at(met.ratio()));
        if R::DECIDES && rule.kills(&met, number) {
            return Draw { value: [0.0], lookups, defect: invariant.defect(weight) };
        }
        invariant.take(weight, rule.due(ratio, outcome.survival));
        weight *= outcome.weight;
    }
    Draw { value: [weight], lookups, defect: invariant.defect(weight) }
}

/// What a particle began with, and what its collisions took.
#[derive(Debug, Clone, Copy)]
pub struct Invariant<L = f64> {
    /// The weight at the beginning.
    pub begin: L,
    /// What collisions took.
    pub taken: L,
    /// The sum of the sizes of all of it, by which rounding is measured.
    pub scale: L,
}

impl<L: Lane> Invariant<L> {
    /// Invariant of a particle that begins with a weight.
    #[inline(always)]
    pub fn open(weight: L) -> Self {
        Self { begin: weight, taken: weight.each(0.0), scale: weight.size() }
    }

    /// Notes the share that a collision takes from a particle that survives it: all but what is
    /// due to it, `(1 − r)/q`.
    #[inline(always)]
    pub fn take(&mut self, weight: L, due: L) {
        let share = weight * (weight.each(1.0) - due);
        self.taken = self.taken + share;
        self.scale = self.scale + share.size();
    }

    /// What is missing at the end, relative to the sizes of all; rounding in a correct walk.
    #[inline(always)]
    pub fn defect(&self, weight: L) -> L {
        (weight + self.taken - self.begin).size() / self.scale
    }
}

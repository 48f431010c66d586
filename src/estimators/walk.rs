//! The walk from tentative collision to tentative collision that all product estimators share.
//!
//! ```text
//! X = T_c ∏ W(tᵢ),  tᵢ a Poisson process of rate σ̂ on the support
//! ```
//!
//! It is the algorithm *Transmittance* of Szirmay-Kalos et al. 2017, section 4.2, with the rule at
//! a collision left open. The free flight to the next collision inverts `∫σ̂` exactly.

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
    let mut lookups = 0;
    while let Some(sampling) = setup.sampling.fly(&mut cursor, exponential(rng)) {
        let residual = medium.extinction(cursor.t) - setup.control.extinction(cursor.t);
        lookups += 1;
        let outcome = rule.outcome(residual / sampling);
        if outcome.survival < 1.0 && unit(rng) >= outcome.survival {
            return Draw { value: [0.0], lookups };
        }
        weight *= outcome.weight;
    }
    Draw { value: [weight], lookups }
}

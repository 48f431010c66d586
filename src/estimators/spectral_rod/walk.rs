//! The analog walk through a rod, and what its number of scatterings says of all channels.
//!
//! ```text
//! fly forward or backward through σ̂; at a tentative collision the particle goes straight on with probability
//! 1 − r, r = σ_t/σ̂, is scattered with a r, and absorbed otherwise; scattered, it turns round with 1 − p_f
//! ```
//!
//! A flight and what happens at its end take a random number each; a scattering takes a third.

use super::Coloured;
use crate::estimators::{Refusal, Setup};
use crate::media::{Extinction, Lookups};
use crate::problems::SpectralRod;
use crate::problems::spectral_rod::End;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;

/// What became of a particle.
pub struct Left {
    /// The end at which it left; `None` if it was absorbed.
    pub end: Option<End>,
    /// How often it was scattered.
    pub order: u32,
    /// The tentative collisions.
    pub lookups: u32,
}

/// Walks with a chance to be scattered at a real collision.
#[inline(always)]
pub fn walk(setup: &Setup<SpectralRod>, medium: &Lookups, rng: &mut Stream, scatter: f64) -> Left {
    let mut cursor = setup.sampling.begin();
    let mut is_forward = true;
    let (mut order, mut lookups) = (0, 0);
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let flown = if is_forward {
            setup.sampling.fly(&mut cursor, depth)
        } else {
            setup.sampling.fly_back(&mut cursor, depth)
        };
        let Some(sampling) = flown else {
            let end = Some(if is_forward { End::Transmitted } else { End::Reflected });
            return Left { end, order, lookups };
        };
        lookups += 1;
        let ratio = medium.extinction(cursor.t) / sampling;
        if number < 1.0 - ratio {
            continue;
        }
        if number >= 1.0 - ratio + scatter * ratio {
            return Left { end: None, order, lookups };
        }
        order += 1;
        is_forward ^= rng.uniform() >= setup.problem.forward;
    }
}

/// σ̂ ≥ σ_t, few collisions, one hero probability for each channel, and an answer.
///
/// # Errors
///
/// What is violated.
pub fn require<P: Coloured>(setup: &Setup<P>, heroes: &Heroes) -> Result<(), Refusal> {
    heroes.require(setup.problem.colours().albedos.len())?;
    setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
    setup.require_few_collisions("∫σ̂ ≤ 1e6")?;
    P::require_answer(setup)
}

/// A variance of each channel.
///
/// # Errors
///
/// The channel, and what its body would have to be.
pub fn require_variance(diverges: Option<(usize, String)>) -> Result<(), Refusal> {
    diverges.map_or(Ok(()), |(channel, why)| {
        let found = format!("E[X²] of channel {} is infinite {why}", channel + 1);
        Err(Refusal::mismatch("a finite variance", found))
    })
}

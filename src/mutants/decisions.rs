//! Random numbers used for more than one thing.
//!
//! ```text
//! flight i from uᵢ, decision i from vᵢ;  all uᵢ and vᵢ independent
//! ```
//!
//! Every number by itself is right, and so is every flight and every decision; together they are
//! not: who flies far decides otherwise than who does not.

use super::Mutant;
use super::fault::{Fault, Memory};
use super::target::{TERMINATING, WOODCOCK};
use super::walk::product;
use crate::estimators::rules::{Null, Single};
use crate::numeric::Lane;
use crate::problems::Transmittance;
use crate::rng::{Stream, unit};

/// The family.
#[must_use]
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("number-shared", "one random number for the distance and for the decision", WOODCOCK, "mean", Null, Shared),
        product("number-shared-reversed", "the distance from u, the decision from 1 − u", WOODCOCK, "mean", Null, SharedReversed),
        product("number-stale", "the decision takes the number of the flight before", WOODCOCK, "mean", Null, Stale),
        product("number-of-first-decision", "one number for all decisions of a walk", TERMINATING, "variance", Single::Terminating, OneForAll),
    ]
}

fn remembered_flight(memory: &mut Memory, rng: &mut Stream) -> f64 {
    let number = unit(rng);
    memory.older = memory.number.replace(number);
    -Lane::ln(1.0 - number)
}

/// `vᵢ = uᵢ`.
#[derive(Clone, Copy)]
pub struct Shared;

impl Fault for Shared {
    #[inline(always)]
    fn flight(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        remembered_flight(memory, rng)
    }

    #[inline(always)]
    fn number(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        memory.number.unwrap_or_else(|| unit(rng))
    }
}

/// `vᵢ = 1 − uᵢ`.
#[derive(Clone, Copy)]
struct SharedReversed;

impl Fault for SharedReversed {
    #[inline(always)]
    fn flight(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        remembered_flight(memory, rng)
    }

    #[inline(always)]
    fn number(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        1.0 - memory.number.unwrap_or_else(|| unit(rng))
    }
}

/// `vᵢ = uᵢ₋₁`; the first is fresh.
#[derive(Clone, Copy)]
pub struct Stale;

impl Fault for Stale {
    #[inline(always)]
    fn flight(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        remembered_flight(memory, rng)
    }

    #[inline(always)]
    fn number(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        memory.older.unwrap_or_else(|| unit(rng))
    }
}

/// `vᵢ = v₁`.
#[derive(Clone, Copy)]
pub struct OneForAll;

impl Fault for OneForAll {
    #[inline(always)]
    fn number(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        *memory.number.get_or_insert_with(|| unit(rng))
    }
}

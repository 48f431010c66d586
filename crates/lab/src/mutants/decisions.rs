//! Random numbers used for more than one thing.
//!
//! ```text
//! flight i from uᵢ, decision i from vᵢ;  all uᵢ and vᵢ independent
//! ```
//!
//! Every number by itself is right, and so is every flight and every decision; together they are
//! not: who flies far decides otherwise than who does not.

use super::Mutant;
use super::fault::{Fault, Memory, RIGHT};
use super::target::{TERMINATING, WOODCOCK};
use super::walk::product;
use numeric::Lane;
use numeric::rng::{Stream, unit};
use theory::problems::Transmittance;
use theory::rules::{Null, Single};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("number-shared", "one random number for the distance and for the decision", WOODCOCK, "mean", Null, SHARED),
        product("number-shared-reversed", "the distance from u, the decision from 1 − u", WOODCOCK, "mean", Null, SHARED_REVERSED),
        product("number-stale", "the decision takes the number of the flight before", WOODCOCK, "mean", Null, STALE),
        product("number-of-first-decision", "one number for all decisions of a walk", TERMINATING, "variance", Single::Terminating, ONE_FOR_ALL),
    ]
}

fn remembered_flight(memory: &mut Memory, rng: &mut Stream) -> f64 {
    let number = unit(rng);
    memory.older = memory.number.replace(number);
    -Lane::ln(1.0 - number)
}

/// `vᵢ = uᵢ`.
pub const SHARED: Fault = Fault {
    flight: remembered_flight,
    number: |memory, rng| memory.number.unwrap_or_else(|| unit(rng)),
    ..RIGHT
};

/// `vᵢ = 1 − uᵢ`.
const SHARED_REVERSED: Fault = Fault {
    flight: remembered_flight,
    number: |memory, rng| 1.0 - memory.number.unwrap_or_else(|| unit(rng)),
    ..RIGHT
};

/// `vᵢ = uᵢ₋₁`; the first is fresh.
pub const STALE: Fault = Fault {
    flight: remembered_flight,
    number: |memory, rng| memory.older.unwrap_or_else(|| unit(rng)),
    ..RIGHT
};

/// `vᵢ = v₁`.
pub const ONE_FOR_ALL: Fault =
    Fault { number: |memory, rng| *memory.number.get_or_insert_with(|| unit(rng)), ..RIGHT };

//! Wrong rules of the single particle model.
//!
//! ```text
//! W = (1 − r)/q with probability q, else 0
//! terminating      q = |1 − r|,                        0 ≤ r ≤ 2
//! non-terminating  q = |1 − r|/D, D = a|r| + |1 − r|,  every r
//! ```
//!
//! What is spent as a chance must come back as a weight, with its sign.

use super::Mutant;
use super::fault::{Fault, RIGHT};
use super::target::{ADAPTIVE, CLAMPED, NON_TERMINATING, RATIO_ONE, TERMINATING, WOODCOCK};
use super::walk::product;
use theory::problems::Transmittance;
use theory::rules::{Null, Single};
use theory::{Outcome, Rule};

/// The albedo of the experiments.
const ALBEDO: f64 = 0.7;
const FULL: Single = Single::NonTerminating { albedo: ALBEDO };

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("majorant-too-low", "a majorant of 0.6 times its size; what exceeds it is clamped", WOODCOCK, "mean", Null, TOO_LOW),
        product("real-for-null", "real and null collisions are mixed up", WOODCOCK, "mean", Null, changed(swapped)),
        product("terminating-beyond-two", "the terminating rule where |1 − r| > 1", CLAMPED, "mean", Single::Clamped, changed(beyond_two)),
        product("chance-without-absolute", "1 − r for |1 − r| as a chance", TERMINATING, "mean", Single::Terminating, changed(without_absolute)),
        product("sign-lost", "the survivor of a collision with r > 1 keeps its sign", TERMINATING, "mean", Single::Terminating, changed(unsigned)),
        product("sign-lost-non-terminating", "weight D for −D where r > 1", NON_TERMINATING, "mean", FULL, changed(unsigned)),
        product("inverse-chance-missing", "the survivor's weight is not divided by q", NON_TERMINATING, "mean", FULL, changed(undivided)),
        product("inverse-chance-twice", "the survivor's weight is divided by q twice", NON_TERMINATING, "variance", FULL, changed(divided_twice)),
        product("albedo-in-weight", "the transmitted weight is multiplied by the albedo", NON_TERMINATING, "mean", FULL, changed(albedo)),
        product("adaptive-literal", "D = a r + |1 − r| without the absolute value of r, as the pseudo-code has it", ADAPTIVE, "mean", Single::Adaptive { albedo: ALBEDO }, changed(literal)),
        product("zero-over-zero", "q = 0/0 at r = 1 and albedo 0: no comparison ends the walk", RATIO_ONE, "lookups", Single::NonTerminating { albedo: 0.0 }, changed(zero_over_zero)),
    ]
}

/// σ̂ times 0.6.
pub const TOO_LOW: Fault =
    Fault { prepare: |setup| *setup.sampling = setup.sampling.scaled(0.6), ..RIGHT };

/// What should happen at a ratio, changed.
const fn changed(outcome: fn(Outcome, f64) -> Outcome) -> Fault {
    Fault { outcome, ..RIGHT }
}

fn weighing(right: Outcome, weight: f64) -> Outcome {
    Outcome { weight, loss: 1.0 - weight, ..right }
}

/// `q = r`.
fn swapped(right: Outcome, _: f64) -> Outcome {
    Outcome { survival: 1.0 - right.survival, ..right }
}

/// `q = min(1, |1 − r|)`, weight ±1.
fn beyond_two(_: Outcome, ratio: f64) -> Outcome {
    Single::Terminating.outcome(ratio)
}

/// `q = max(0, 1 − r)`, weight 1.
fn without_absolute(right: Outcome, ratio: f64) -> Outcome {
    Outcome { survival: (1.0 - ratio).clamp(0.0, 1.0), ..weighing(right, 1.0) }
}

/// `|W|`.
fn unsigned(right: Outcome, _: f64) -> Outcome {
    weighing(right, right.weight.abs())
}

/// `W = 1 − r`.
fn undivided(right: Outcome, ratio: f64) -> Outcome {
    weighing(right, 1.0 - ratio)
}

/// `W = (1 − r)/q²`.
fn divided_twice(right: Outcome, _: f64) -> Outcome {
    weighing(right, right.weight / right.survival)
}

/// `a W`.
fn albedo(right: Outcome, _: f64) -> Outcome {
    weighing(right, ALBEDO * right.weight)
}

/// `q = (1 − r)/D > 1` and weight D for `r < 0`: a survivor for certain, with too small a weight.
fn literal(right: Outcome, ratio: f64) -> Outcome {
    if ratio >= 0.0 {
        return right;
    }
    let sum = ALBEDO * ratio + (1.0 - ratio);
    Outcome { survival: (1.0 - ratio) / sum, ..weighing(right, sum) }
}

/// `q = |1 − r|/(0 + |1 − r|) = NaN`: `u ≥ q` is false, and the walk goes on with a weight of 0.
fn zero_over_zero(right: Outcome, ratio: f64) -> Outcome {
    let (scattered, transmitted) = (0.0, (1.0 - ratio).abs());
    Outcome { survival: transmitted / (scattered + transmitted), ..right }
}

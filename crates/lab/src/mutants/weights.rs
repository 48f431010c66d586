//! Wrong weights of walks that never end early.
//!
//! ```text
//! W = 1 − r,  r = (σ_t − σ_c)/σ̂,  of either sign;  X = T_c ∏ W(tᵢ)
//! ```
//!
//! The mean is right only if `E[W] = 1 − r` at every collision: a sign, a bound or a cut that looks
//! harmless for `0 ≤ r ≤ 1` is a bias elsewhere.

use super::Mutant;
use super::fault::{Fault, RIGHT};
use super::target::{BELOW, DENSE, NEGATIVE, STEPS};
use super::walk::product;
use numeric::Lane;
use numeric::rng::unit;
use theory::Outcome;
use theory::problems::Transmittance;
use theory::rules::Weight;

/// A function of `1 − r` for `1 − r`.
macro_rules! replaced {
    ($by:expr) => {
        Fault {
            outcome: |right, ratio| {
                let by: fn(f64) -> f64 = $by;
                let weight = by(1.0 - ratio);
                Outcome { weight, loss: 1.0 - weight, ..right }
            },
            ..RIGHT
        }
    };
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("weight-absolute", "|1 − r| for 1 − r", BELOW, "mean", Weight, replaced!(f64::abs)),
        product("weight-clamped", "max(0, 1 − r) for 1 − r", BELOW, "mean", Weight, replaced!(|w| w.max(0.0))),
        product("weight-exponential", "exp(−r) for 1 − r", BELOW, "mean", Weight, replaced!(|w| Lane::exp(w - 1.0))),
        product("weight-albedo", "the transmitted weight is multiplied by the albedo 0.9 at every collision", BELOW, "mean", Weight, replaced!(|w| 0.9 * w)),
        product("weight-logarithm", "ln(1 − r) is summed up, which is not a number for r > 1", BELOW, "numeric", Weight, replaced!(|w| w.ln().exp())),
        product("draw-clamped", "max(0, X) for X", BELOW, "mean", Weight, DRAW_CLAMPED),
        product("residual-clamped", "max(0, σ_t − σ_c) for σ_t − σ_c", NEGATIVE, "mean", Weight, RESIDUAL_CLAMPED),
        product("residual-absolute", "|σ_t − σ_c| for σ_t − σ_c", NEGATIVE, "mean", Weight, RESIDUAL_ABSOLUTE),
        product("weight-global-majorant", "flown with the local σ̂, divided by the largest", STEPS, "mean", Weight, GLOBAL_MAJORANT),
        product("last-factor-missing", "the draw is the weight before the last collision", BELOW, "mean", Weight, LAST_MISSING),
        product("roulette-uncompensated", "below a weight of 0.1 Russian roulette ends half of the walks and leaves the others as they are", DENSE, "lookups", Weight, ROULETTE),
        product("cut-off", "below a weight of 0.1 the walk ends as 0", DENSE, "lookups", Weight, CUT_OFF),
    ]
}

/// `max(0, X)`.
const DRAW_CLAMPED: Fault = Fault { end: |_, _, weight| weight.max(0.0), ..RIGHT };

/// `max(0, σ_t − σ_c)`.
const RESIDUAL_CLAMPED: Fault =
    Fault { ratio: |_, residual, here| residual.max(0.0) / here, ..RIGHT };

/// `|σ_t − σ_c|`.
const RESIDUAL_ABSOLUTE: Fault =
    Fault { ratio: |_, residual, here| residual.abs() / here, ..RIGHT };

/// `r = σ_t(t)/max σ̂`.
const GLOBAL_MAJORANT: Fault = Fault {
    ratio: |sampling, residual, _| residual / sampling.corner_values().fold(0.0, f64::max),
    ..RIGHT
};

/// `∏ W(tᵢ)` over `i < N`.
const LAST_MISSING: Fault = Fault { end: |memory, _, _| memory.before, ..RIGHT };

/// Survivors should have twice their weight.
const ROULETTE: Fault = Fault {
    stop: |_, weight, rng| (weight.abs() < 0.1 && unit(rng) < 0.5).then_some(0.0),
    ..RIGHT
};

/// No roulette at all.
const CUT_OFF: Fault = Fault { stop: |_, weight, _| (weight.abs() < 0.1).then_some(0.0), ..RIGHT };

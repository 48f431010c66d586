//! Wrong weights of walks that never end early.
//!
//! ```text
//! W = 1 − r,  r = (σ_t − σ_c)/σ̂,  of either sign;  X = T_c ∏ W(tᵢ)
//! ```
//!
//! The mean is right only if `E[W] = 1 − r` at every collision: a sign, a bound or a cut that looks
//! harmless for `0 ≤ r ≤ 1` is a bias elsewhere.

use super::Mutant;
use super::fault::{Fault, Memory};
use super::target::{BELOW, DENSE, NEGATIVE, STEPS};
use super::walk::product;
use crate::estimators::rules::Weight;
use crate::media::{Control, Piecewise};
use crate::numeric::Lane;
use crate::problems::Transmittance;
use crate::rng::{Stream, unit};
use crate::theory::{Outcome, Rule};

/// The family.
#[must_use]
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("weight-absolute", "|1 − r| for 1 − r", BELOW, "mean", Weight, Replaced(f64::abs)),
        product("weight-clamped", "max(0, 1 − r) for 1 − r", BELOW, "mean", Weight, Replaced(|w| w.max(0.0))),
        product("weight-exponential", "exp(−r) for 1 − r", BELOW, "mean", Weight, Replaced(|w| Lane::exp(w - 1.0))),
        product("weight-albedo", "the transmitted weight is multiplied by the albedo 0.9 at every collision", BELOW, "mean", Weight, Replaced(|w| 0.9 * w)),
        product("weight-logarithm", "ln(1 − r) is summed up, which is not a number for r > 1", BELOW, "numeric", Weight, Replaced(|w| w.ln().exp())),
        product("draw-clamped", "max(0, X) for X", BELOW, "mean", Weight, DrawClamped),
        product("residual-clamped", "max(0, σ_t − σ_c) for σ_t − σ_c", NEGATIVE, "mean", Weight, Residual(|r| r.max(0.0))),
        product("residual-absolute", "|σ_t − σ_c| for σ_t − σ_c", NEGATIVE, "mean", Weight, Residual(f64::abs)),
        product("weight-global-majorant", "flown with the local σ̂, divided by the largest", STEPS, "mean", Weight, GlobalMajorant),
        product("last-factor-missing", "the draw is the weight before the last collision", BELOW, "mean", Weight, LastMissing),
        product("roulette-uncompensated", "below a weight of 0.1 Russian roulette ends half of the walks and leaves the others as they are", DENSE, "lookups", Weight, Roulette),
        product("cut-off", "below a weight of 0.1 the walk ends as 0", DENSE, "lookups", Weight, CutOff),
    ]
}

/// A function of `1 − r` for `1 − r`.
#[derive(Clone, Copy)]
struct Replaced(fn(f64) -> f64);

impl Fault for Replaced {
    #[inline(always)]
    fn outcome<R: Rule>(&self, rule: &R, ratio: f64) -> Outcome {
        let weight = (self.0)(1.0 - ratio);
        Outcome { weight, loss: 1.0 - weight, ..rule.outcome(ratio) }
    }
}

/// `max(0, X)`.
#[derive(Clone, Copy)]
struct DrawClamped;

impl Fault for DrawClamped {
    #[inline(always)]
    fn end(&self, _: &mut Memory, _: &Control, weight: f64) -> f64 {
        weight.max(0.0)
    }
}

/// A function of the residual for the residual.
#[derive(Clone, Copy)]
struct Residual(fn(f64) -> f64);

impl Fault for Residual {
    #[inline(always)]
    fn ratio(&self, _: &Piecewise, residual: f64, here: f64) -> f64 {
        (self.0)(residual) / here
    }
}

/// `r = σ_t(t)/max σ̂`.
#[derive(Clone, Copy)]
struct GlobalMajorant;

impl Fault for GlobalMajorant {
    fn ratio(&self, sampling: &Piecewise, residual: f64, _: f64) -> f64 {
        residual / sampling.corner_values().fold(0.0, f64::max)
    }
}

/// `∏ W(tᵢ)` over `i < N`.
#[derive(Clone, Copy)]
struct LastMissing;

impl Fault for LastMissing {
    #[inline(always)]
    fn end(&self, memory: &mut Memory, _: &Control, _: f64) -> f64 {
        memory.before
    }
}

/// Survivors should have twice their weight.
#[derive(Clone, Copy)]
struct Roulette;

impl Fault for Roulette {
    #[inline(always)]
    fn stop(&self, _: &Memory, weight: f64, rng: &mut Stream) -> Option<f64> {
        (weight.abs() < 0.1 && unit(rng) < 0.5).then_some(0.0)
    }
}

/// No roulette at all.
#[derive(Clone, Copy)]
struct CutOff;

impl Fault for CutOff {
    #[inline(always)]
    fn stop(&self, _: &Memory, weight: f64, _: &mut Stream) -> Option<f64> {
        (weight.abs() < 0.1).then_some(0.0)
    }
}

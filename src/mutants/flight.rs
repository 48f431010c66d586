//! Wrong flights, and walks that begin or end in the wrong place.
//!
//! ```text
//! ∫ σ̂ from tᵢ₋₁ to tᵢ = −ln(1 − u);  the walk ends where tᵢ ≥ S, without a lookup
//! ```
//!
//! Lookups are then Poisson with mean ∫σ̂, and the mean of a draw is right only if the σ̂ that was
//! flown with is the σ̂ that is divided by.

use super::Mutant;
use super::fault::{Fault, Memory};
use super::target::{BELOW, DENSE, LINEAR, STEPS, WOODCOCK};
use super::walk::product;
use crate::estimators::Setup;
use crate::estimators::rules::{Null, Weight};
use crate::media::{Control, Cursor, Piecewise};
use crate::numeric::Span;
use crate::problems::{Problem, Transmittance};
use crate::rng::{Stream, exponential};

/// The family.
#[must_use]
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("flight-log2", "log2 for ln in the flight", BELOW, "lookups", Weight, Log2),
        product("flight-sampling-off", "σ̂ is off by a thousandth in the flight", DENSE, "lookups", Weight, Scaled(1.001)),
        product("weight-sampling-off", "σ̂ is off by a thousandth in the weight", DENSE, "mean", Weight, Divided(1.001)),
        product("flight-hole", "σ̂ is zero on a tenth of the ray", WOODCOCK, "mean", Null, Hole),
        product("flight-linear-as-constant", "a linear σ̂ is flown as if it stayed what it is at the flight's beginning", LINEAR, "lookups", Weight, AsConstant),
        product("flight-over-boundary", "a flight crosses a boundary with the σ̂ before it", STEPS, "mean", Weight, AsConstant),
        product("flight-replayed", "from half the ray on, the generator repeats the draw's first numbers", BELOW, "mean", Weight, Replayed),
        product("buffers-replayed", "every 1024 draws of a block begin with the same random numbers", LINEAR, "dispersion", Weight, BuffersReplayed),
        product("flight-short-ray", "the walk begins and ends a hundredth of the ray inside", DENSE, "lookups", Weight, ShortRay),
        product("end-weighted", "a flight beyond the end is clamped to the end and weighted", BELOW, "mean", Weight, EndWeighted),
        product("first-skipped", "the first collision leaves the weight as it is", BELOW, "mean", Weight, FirstSkipped),
        product("lookup-before-end-test", "σ_t is looked up before the end is tested: one lookup too many", BELOW, "lookups", Weight, LateEnd),
        product("cap-16", "a walk stops after 16 lookups and returns its weight", DENSE, "mean", Weight, Cap(16)),
        product("cap-100", "a walk stops after 100 lookups and returns its weight", DENSE, "counts", Weight, Cap(100)),
        product("cap-4", "a walk stops after 4 lookups and counts as through", WOODCOCK, "mean", Null, Cap(4)),
    ]
}

/// `−log₂(1 − u)`.
#[derive(Clone, Copy)]
pub struct Log2;

impl Fault for Log2 {
    #[inline(always)]
    fn flight(&self, _: &mut Memory, rng: &mut Stream) -> f64 {
        exponential(rng) * std::f64::consts::LOG2_E
    }
}

/// Flown with `f σ̂`, divided by σ̂.
#[derive(Clone, Copy)]
struct Scaled(f64);

impl Fault for Scaled {
    #[inline(always)]
    fn flight(&self, _: &mut Memory, rng: &mut Stream) -> f64 {
        exponential(rng) / self.0
    }
}

/// Flown with σ̂, divided by `f σ̂`.
#[derive(Clone, Copy)]
struct Divided(f64);

impl Fault for Divided {
    #[inline(always)]
    fn ratio(&self, _: &Piecewise, residual: f64, here: f64) -> f64 {
        residual / (here * self.0)
    }
}

/// `σ̂ = 0` from 0.4 to 0.5 of the ray.
#[derive(Clone, Copy)]
pub struct Hole;

impl Fault for Hole {
    fn prepare<P: Problem>(&self, setup: Setup<P>) -> Setup<P> {
        let support = setup.mesh.support();
        let value = setup.sampling.value(support.from);
        let at = |share: f64| support.from + share * support.length();
        let breaks = [support.from, at(0.4), at(0.5), support.to];
        Setup { sampling: Piecewise::steps(&breaks, &[value, 0.0, value]), ..setup }
    }
}

/// `tᵢ = tᵢ₋₁ − ln(1 − u)/σ̂(tᵢ₋₁)`.
#[derive(Clone, Copy)]
pub struct AsConstant;

impl Fault for AsConstant {
    fn fly(&self, sampling: &Piecewise, cursor: &mut Cursor, depth: f64) -> Option<f64> {
        let knots = sampling.knots();
        cursor.t += depth / sampling.value(cursor.t);
        (cursor.t < knots[knots.len() - 1]).then(|| sampling.value(cursor.t))
    }
}

/// The flights of the second half are those of the first: its weight is that weight's echo.
#[derive(Clone, Copy)]
struct Replayed;

impl Fault for Replayed {
    fn flight(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        let replays = memory.from > memory.support.middle();
        exponential(if replays { &mut memory.beginning } else { rng })
    }
}

/// σ̂ on the inner 98 % of the support.
#[derive(Clone, Copy)]
pub struct ShortRay;

impl Fault for ShortRay {
    fn prepare<P: Problem>(&self, setup: Setup<P>) -> Setup<P> {
        let support = setup.mesh.support();
        let inset = 0.01 * support.length();
        let inner = Span::new(support.from + inset, support.to - inset);
        Setup { sampling: setup.sampling.on(inner), ..setup }
    }
}

/// A factor `1 − r(S)` for every walk that reaches the end.
#[derive(Clone, Copy)]
struct EndWeighted;

impl Fault for EndWeighted {
    fn fly(&self, sampling: &Piecewise, cursor: &mut Cursor, depth: f64) -> Option<f64> {
        let from = cursor.t;
        let knots = sampling.knots();
        let end = knots[knots.len() - 1];
        sampling.fly(cursor, depth).or_else(|| {
            cursor.t = end;
            (from < end).then(|| sampling.value(end))
        })
    }
}

/// `∏ W(tᵢ)` over `i ≥ 2`.
#[derive(Clone, Copy)]
pub struct FirstSkipped;

impl Fault for FirstSkipped {
    #[inline(always)]
    fn weigh(&self, memory: &Memory, weight: f64, factor: f64) -> f64 {
        if memory.lookups == 1 { weight } else { weight * factor }
    }

    #[inline(always)]
    fn real(&self, memory: &Memory, real: bool) -> bool {
        real && memory.lookups > 1
    }
}

/// One generator's numbers from the beginning, again and again.
#[derive(Clone, Copy)]
pub struct BuffersReplayed;

impl Fault for BuffersReplayed {
    const REPLAYS: bool = true;
}

/// N + 1 lookups.
#[derive(Clone, Copy)]
pub struct LateEnd;

impl Fault for LateEnd {
    #[inline(always)]
    fn end(&self, memory: &mut Memory, _: &Control, weight: f64) -> f64 {
        memory.lookups += 1;
        weight
    }
}

/// At most so many lookups.
#[derive(Clone, Copy)]
pub struct Cap(pub u32);

impl Fault for Cap {
    #[inline(always)]
    fn stop(&self, memory: &Memory, weight: f64, _: &mut Stream) -> Option<f64> {
        (memory.lookups >= self.0).then_some(weight)
    }
}

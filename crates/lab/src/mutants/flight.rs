//! Wrong flights, and walks that begin or end in the wrong place.
//!
//! ```text
//! ∫ σ̂ from tᵢ₋₁ to tᵢ = −ln(1 − u);  the walk ends where tᵢ ≥ S, without a lookup
//! ```
//!
//! Lookups are then Poisson with mean ∫σ̂, and the mean of a draw is right only if the σ̂ that was
//! flown with is the σ̂ that is divided by.

use super::Mutant;
use super::fault::{Fault, Memory, RIGHT};
use super::target::{BELOW, DENSE, LINEAR, STEPS, WOODCOCK};
use super::walk::product;
use media::Piecewise;
use numeric::Span;
use numeric::rng::exponential;
use theory::problems::Transmittance;
use theory::rules::{Null, Weight};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    vec![
        product("flight-log2", "log2 for ln in the flight", BELOW, "lookups", Weight, LOG2),
        product("flight-sampling-off", "σ̂ is off by a thousandth in the flight", DENSE, "lookups", Weight, FLOWN_OFF),
        product("weight-sampling-off", "σ̂ is off by a thousandth in the weight", DENSE, "mean", Weight, DIVIDED_OFF),
        product("flight-hole", "σ̂ is zero on a tenth of the ray", WOODCOCK, "mean", Null, HOLE),
        product("flight-linear-as-constant", "a linear σ̂ is flown as if it stayed what it is at the flight's beginning", LINEAR, "lookups", Weight, AS_CONSTANT),
        product("flight-over-boundary", "a flight crosses a boundary with the σ̂ before it", STEPS, "mean", Weight, AS_CONSTANT),
        product("flight-replayed", "from half the ray on, the generator repeats the draw's first numbers", BELOW, "mean", Weight, REPLAYED),
        product("buffers-replayed", "every 1024 draws of a block begin with the same random numbers", LINEAR, "dispersion", Weight, BUFFERS_REPLAYED),
        product("flight-short-ray", "the walk begins and ends a hundredth of the ray inside", DENSE, "lookups", Weight, SHORT_RAY),
        product("end-weighted", "a flight beyond the end is clamped to the end and weighted", BELOW, "mean", Weight, END_WEIGHTED),
        product("first-skipped", "the first collision leaves the weight as it is", BELOW, "mean", Weight, FIRST_SKIPPED),
        product("lookup-before-end-test", "σ_t is looked up before the end is tested: one lookup too many", BELOW, "lookups", Weight, LATE_END),
        product("cap-16", "a walk stops after 16 lookups and returns its weight", DENSE, "mean", Weight, CAP_16),
        product("cap-100", "a walk stops after 100 lookups and returns its weight", DENSE, "counts", Weight, CAP_100),
        product("cap-4", "a walk stops after 4 lookups and counts as through", WOODCOCK, "mean", Null, CAP_4),
    ]
}

/// `−log₂(1 − u)`.
pub const LOG2: Fault =
    Fault { flight: |_, rng| exponential(rng) * std::f64::consts::LOG2_E, ..RIGHT };

/// Flown with `1.001 σ̂`, divided by σ̂.
const FLOWN_OFF: Fault = Fault { flight: |_, rng| exponential(rng) / 1.001, ..RIGHT };

/// Flown with σ̂, divided by `1.001 σ̂`.
const DIVIDED_OFF: Fault = Fault { ratio: |_, residual, here| residual / (here * 1.001), ..RIGHT };

/// `σ̂ = 0` from 0.4 to 0.5 of the ray.
pub const HOLE: Fault = Fault {
    prepare: |setup| {
        let support = setup.mesh.support();
        let value = setup.sampling.value(support.from);
        let at = |share: f64| support.from + share * support.length();
        let breaks = [support.from, at(0.4), at(0.5), support.to];
        *setup.sampling = Piecewise::steps(&breaks, &[value, 0.0, value]);
    },
    ..RIGHT
};

/// `tᵢ = tᵢ₋₁ − ln(1 − u)/σ̂(tᵢ₋₁)`.
pub const AS_CONSTANT: Fault = Fault {
    fly: |sampling, cursor, depth| {
        let knots = sampling.knots();
        cursor.t += depth / sampling.value(cursor.t);
        (cursor.t < knots[knots.len() - 1]).then(|| sampling.value(cursor.t))
    },
    ..RIGHT
};

/// The flights of the second half are those of the first: its weight is that weight's echo.
const REPLAYED: Fault = Fault {
    flight: |memory, rng| {
        let replays = memory.from > memory.support.middle();
        exponential(if replays { &mut memory.beginning } else { rng })
    },
    ..RIGHT
};

/// σ̂ on the inner 98 % of the support.
pub const SHORT_RAY: Fault = Fault {
    prepare: |setup| {
        let support = setup.mesh.support();
        let inset = 0.01 * support.length();
        let inner = Span::new(support.from + inset, support.to - inset);
        *setup.sampling = setup.sampling.on(inner);
    },
    ..RIGHT
};

/// A factor `1 − r(S)` for every walk that reaches the end.
const END_WEIGHTED: Fault = Fault {
    fly: |sampling, cursor, depth| {
        let from = cursor.t;
        let knots = sampling.knots();
        let end = knots[knots.len() - 1];
        sampling.fly(cursor, depth).or_else(|| {
            cursor.t = end;
            (from < end).then(|| sampling.value(end))
        })
    },
    ..RIGHT
};

/// `∏ W(tᵢ)` over `i ≥ 2`.
pub const FIRST_SKIPPED: Fault = Fault {
    weigh: |memory, weight, factor| if memory.lookups == 1 { weight } else { weight * factor },
    real: |memory, real| real && memory.lookups > 1,
    ..RIGHT
};

/// One generator's numbers from the beginning, again and again.
const BUFFERS_REPLAYED: Fault = Fault { replays: true, ..RIGHT };

/// N + 1 lookups.
pub const LATE_END: Fault = Fault {
    end: |memory, _, weight| {
        memory.lookups += 1;
        weight
    },
    ..RIGHT
};

/// At most four lookups.
pub const CAP_4: Fault = Fault { stop: |memory, weight, _| cap(4, memory, weight), ..RIGHT };
/// At most 16.
const CAP_16: Fault = Fault { stop: |memory, weight, _| cap(16, memory, weight), ..RIGHT };
/// At most 100.
const CAP_100: Fault = Fault { stop: |memory, weight, _| cap(100, memory, weight), ..RIGHT };

fn cap(most: u32, memory: &Memory, weight: f64) -> Option<f64> {
    (memory.lookups >= most).then_some(weight)
}

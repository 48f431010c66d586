//! Wrong free flights, by Woodcock tracking.
//!
//! ```text
//! P(s ≤ t) = 1 − T(t);  s counts from the beginning of the ray, and escapes score its length S
//! ```

use super::Mutant;
use super::decisions::{OneForAll, Shared, Stale};
use super::fault::{Fault, Memory};
use super::flight::{AsConstant, Cap, FirstSkipped, Hole, LateEnd, Log2, ShortRay};
use super::lookups::{AtMidpoint, AtPrevious, OfAnotherChannel};
use super::rules::TooLow;
use super::target::{FLIGHT, FLIGHT_LINEAR};
use super::walk::flight;
use crate::numeric::Span;
use crate::problems::FreeFlight;

/// The family.
#[must_use]
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<FreeFlight>> {
    vec![
        flight("free-flight-log2", "log2 for ln in the flight", FLIGHT, "distances", Log2),
        flight("free-flight-at-previous", "σ_t is looked up where the flight began", FLIGHT, "distances", AtPrevious),
        flight("free-flight-at-midpoint", "σ_t is looked up at the flight's midpoint", FLIGHT, "depth", AtMidpoint),
        flight("free-flight-of-another-channel", "the chance of a real collision is that of another colour channel, 0.8 σ_t", FLIGHT, "mean", OfAnotherChannel),
        flight("free-flight-majorant-too-low", "a majorant of 0.6 times its size; what exceeds it is clamped", FLIGHT, "distances", TooLow),
        flight("free-flight-linear-as-constant", "a linear σ̂ is flown as if it stayed what it is at the flight's beginning", FLIGHT_LINEAR, "distances", AsConstant),
        flight("free-flight-hole", "σ̂ is zero on a tenth of the ray", FLIGHT, "depth", Hole),
        flight("free-flight-short-ray", "the walk begins and ends a hundredth of the ray inside", FLIGHT, "mean", ShortRay),
        flight("free-flight-first-skipped", "the first collision is never real", FLIGHT, "distances", FirstSkipped),
        flight("free-flight-cap-4", "the fourth collision is always real", FLIGHT, "mean", Cap(4)),
        flight("free-flight-lookup-before-end-test", "σ_t is looked up before the end is tested: one lookup too many", FLIGHT, "lookups", LateEnd),
        flight("free-flight-number-shared", "one random number for the distance and for the decision", FLIGHT, "distances", Shared),
        flight("free-flight-number-stale", "the decision takes the number of the flight before", FLIGHT, "lookups", Stale),
        flight("free-flight-number-of-first-decision", "one number for all decisions of a walk", FLIGHT, "distances", OneForAll),
        flight("free-flight-from-origin", "distances count from t = 0, not from the ray's beginning", FLIGHT, "distances", FromOrigin),
        flight("free-flight-escape-at-last", "a flight that escapes scores its last collision", FLIGHT, "distances", EscapeAtLast),
    ]
}

/// `s = t`.
#[derive(Clone, Copy)]
struct FromOrigin;

impl Fault for FromOrigin {
    #[inline(always)]
    fn distance(&self, _: Span, t: f64) -> f64 {
        t
    }
}

/// `s = t_N` for `s = S`.
#[derive(Clone, Copy)]
struct EscapeAtLast;

impl Fault for EscapeAtLast {
    #[inline(always)]
    fn escape(&self, memory: &Memory, ray: Span) -> f64 {
        memory.from - ray.from
    }
}

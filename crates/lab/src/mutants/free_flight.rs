//! Wrong free flights, by Woodcock tracking.
//!
//! ```text
//! P(s ≤ t) = 1 − T(t);  s counts from the beginning of the ray, and escapes score its length S
//! ```

use super::Mutant;
use super::decisions::{ONE_FOR_ALL, SHARED, STALE};
use super::fault::{Fault, RIGHT};
use super::flight::{AS_CONSTANT, CAP_4, FIRST_SKIPPED, HOLE, LATE_END, LOG2, SHORT_RAY};
use super::lookups::{AT_MIDPOINT, AT_PREVIOUS, OF_ANOTHER_CHANNEL};
use super::rules::TOO_LOW;
use super::target::{FLIGHT, FLIGHT_LINEAR};
use super::walk::flight;
use theory::problems::FreeFlight;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<FreeFlight>> {
    vec![
        flight("free-flight-log2", "log2 for ln in the flight", FLIGHT, "distances", LOG2),
        flight("free-flight-at-previous", "σ_t is looked up where the flight began", FLIGHT, "distances", AT_PREVIOUS),
        flight("free-flight-at-midpoint", "σ_t is looked up at the flight's midpoint", FLIGHT, "depth", AT_MIDPOINT),
        flight("free-flight-of-another-channel", "the chance of a real collision is that of another colour channel, 0.8 σ_t", FLIGHT, "mean", OF_ANOTHER_CHANNEL),
        flight("free-flight-majorant-too-low", "a majorant of 0.6 times its size; what exceeds it is clamped", FLIGHT, "distances", TOO_LOW),
        flight("free-flight-linear-as-constant", "a linear σ̂ is flown as if it stayed what it is at the flight's beginning", FLIGHT_LINEAR, "distances", AS_CONSTANT),
        flight("free-flight-hole", "σ̂ is zero on a tenth of the ray", FLIGHT, "depth", HOLE),
        flight("free-flight-short-ray", "the walk begins and ends a hundredth of the ray inside", FLIGHT, "mean", SHORT_RAY),
        flight("free-flight-first-skipped", "the first collision is never real", FLIGHT, "distances", FIRST_SKIPPED),
        flight("free-flight-cap-4", "the fourth collision is always real", FLIGHT, "mean", CAP_4),
        flight("free-flight-lookup-before-end-test", "σ_t is looked up before the end is tested: one lookup too many", FLIGHT, "lookups", LATE_END),
        flight("free-flight-number-shared", "one random number for the distance and for the decision", FLIGHT, "distances", SHARED),
        flight("free-flight-number-stale", "the decision takes the number of the flight before", FLIGHT, "lookups", STALE),
        flight("free-flight-number-of-first-decision", "one number for all decisions of a walk", FLIGHT, "distances", ONE_FOR_ALL),
        flight("free-flight-from-origin", "distances count from t = 0, not from the ray's beginning", FLIGHT, "distances", FROM_ORIGIN),
        flight("free-flight-escape-at-last", "a flight that escapes scores its last collision", FLIGHT, "distances", ESCAPE_AT_LAST),
    ]
}

/// `s = t`.
const FROM_ORIGIN: Fault = Fault { distance: |_, t| t, ..RIGHT };

/// `s = t_N` for `s = S`.
const ESCAPE_AT_LAST: Fault = Fault { escape: |memory, ray| memory.from - ray.from, ..RIGHT };

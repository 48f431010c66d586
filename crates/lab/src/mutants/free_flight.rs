//! Wrong free flights, by Woodcock tracking.
//!
//! ```text
//! P(s ≤ t) = 1 − T(t);  s counts from the beginning of the ray, and escapes score its length S
//! u = k/2⁵³, −ln(1 − u) and t in 53 bits
//! ```
//!
//! Lost bits are seen at once in the draws themselves: among n distances made of k/2²⁴ about n²/2²⁵ pairs are equal to the
//! last bit, and positions in single precision are all numbers of 24 bits.

use super::line::{Slip, Wrong};
use super::product::{Bug, hole, on_setups, short_ray, too_low};
use super::{Line, Mutant, Target, family, filled, on};
use estimators::free_flight::woodcock::Flights;
use estimators::walks;
use theory::problems::FreeFlight;

/// A constant majorant, on a line that begins at 1.
const FLIGHT: Target = on("free-flight/known-bugs", 0);
/// A linear majorant.
const LINEAR: Target = on("free-flight/known-bugs", 1);

#[rustfmt::skip] // one mutant, one entry
const LINES: &[Line<Bug<FreeFlight>>] = &[
    ("free-flight-log2", "log2 for ln in the flight", FLIGHT, "distances", Bug::Step(Slip::Deeper(std::f64::consts::LOG2_E))),
    ("free-flight-at-previous", "σ_t is looked up where the flight began", FLIGHT, "distances", Bug::Step(Slip::AtPrevious)),
    ("free-flight-at-midpoint", "σ_t is looked up at the flight's midpoint", FLIGHT, "depth", Bug::Step(Slip::AtMidpoint)),
    ("free-flight-of-another-channel", "the chance of a real collision is that of another colour channel, 0.8 σ_t", FLIGHT, "mean", Bug::Step(Slip::OfAnotherChannel)),
    ("free-flight-majorant-too-low", "a majorant of 0.6 times its size; what exceeds it is clamped", FLIGHT, "distances", Bug::Setup(too_low)),
    ("free-flight-linear-as-constant", "a linear σ̂ is flown as if it stayed what it is at the flight's beginning", LINEAR, "distances", Bug::Step(Slip::AsConstant)),
    ("free-flight-hole", "σ̂ is zero on a tenth of the ray", FLIGHT, "depth", Bug::Setup(hole)),
    ("free-flight-short-ray", "the walk begins and ends a hundredth of the ray inside", FLIGHT, "mean", Bug::Setup(short_ray)),
    ("free-flight-first-skipped", "the first collision is never real", FLIGHT, "distances", Bug::Step(Slip::FirstSkipped)),
    ("free-flight-cap-4", "the fourth collision is always real", FLIGHT, "mean", Bug::Step(Slip::Cap(4.0, false))),
    ("free-flight-lookup-before-end-test", "σ_t is looked up before the end is tested: one lookup too many", FLIGHT, "lookups", Bug::Step(Slip::LateEnd)),
    ("free-flight-number-shared", "one random number for the distance and for the decision", FLIGHT, "distances", Bug::Step(Slip::Shared)),
    ("free-flight-number-stale", "the decision takes the number of the flight before", FLIGHT, "lookups", Bug::Step(Slip::Stale)),
    ("free-flight-number-of-first-decision", "one number for all decisions of a walk", FLIGHT, "distances", Bug::Step(Slip::OneForAll)),
    ("free-flight-from-origin", "distances count from t = 0, not from the ray's beginning", FLIGHT, "distances", Bug::Step(Slip::FromOrigin)),
    ("free-flight-escape-at-last", "a flight that escapes scores its last collision", FLIGHT, "distances", Bug::Step(Slip::EscapeAtLast)),
    ("position-f32", "positions are kept in single precision", FLIGHT, "resolution", Bug::Step(Slip::PositionSingle)),
    ("depth-f32", "the flight's optical depth is computed in single precision", FLIGHT, "resolution", Bug::Step(Slip::FlightSingle)),
    ("uniform-24", "uniform numbers of 24 bits", FLIGHT, "resolution", Bug::Step(Slip::Bits(24))),
    ("uniform-15", "uniform numbers of 15 bits, as of an old rand()", FLIGHT, "resolution", Bug::Step(Slip::Bits(15))),
];

/// The family.
pub fn mutants() -> Vec<Mutant<FreeFlight>> {
    let draws = |_, bug: &Bug<FreeFlight>| {
        let slip = bug.slip();
        filled(move |setup, request| {
            walks::in_turn(&Wrong::new(Flights::new(setup), slip, setup), setup, request);
        })
    };
    on_setups(family(LINES, &Bug::Step(Slip::None), draws), LINES)
}

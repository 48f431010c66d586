//! Wrong free flights, by Woodcock tracking.
//!
//! ```text
//! P(s ≤ t) = 1 − T(t);  s counts from the beginning of the ray, and escapes score its length S
//! u = k/2⁵³, −ln(1 − u) and t in 53 bits
//! ```
//!
//! Lost bits are seen at once in the draws themselves: among n distances made of k/2²⁴ about n²/2²⁵ pairs are equal to the
//! last bit, and positions in single precision are all numbers of 24 bits.
//!
//! `free-flight-of-another-channel` is issue 1387 of Mitsuba 3, `free-flight-majorant-too-low` issue 33 of pbrt-v4.

use super::line::{self, End, Notes, RIGHT, Slip, single};
use super::product::{Bug, hole, on_setups, short_ray, too_low};
use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::free_flight::woodcock::Flights;
use gate::CheckId;
use numeric::Lane;
use theory::problems::FreeFlight;

/// A constant majorant, on a line that begins at 1.
const FLIGHT: On<()> = on("free-flight/known-bugs", 0, ());
/// A linear majorant.
const LINEAR: On<()> = on("free-flight/known-bugs", 1, ());

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<(), Bug<FreeFlight>>] = &[
    ("free-flight-log2", "log2 for ln in the flight", FLIGHT, CheckId::Distances, Bug::Step(line::LOG2)),
    ("free-flight-at-previous", "σ_t is looked up where the flight began", FLIGHT, CheckId::Distances, Bug::Step(line::AT_PREVIOUS)),
    ("free-flight-at-midpoint", "σ_t is looked up at the flight's midpoint", FLIGHT, CheckId::Depth, Bug::Step(line::AT_MIDPOINT)),
    ("free-flight-of-another-channel", "the chance of a real collision is that of another colour channel, 0.8 σ_t", FLIGHT, CheckId::Mean, Bug::Step(line::OF_ANOTHER_CHANNEL)),
    ("free-flight-majorant-too-low", "a majorant of 0.6 times its size; what exceeds it is clamped", FLIGHT, CheckId::Distances, Bug::Setup(too_low)),
    ("free-flight-linear-as-constant", "a linear σ̂ is flown as if it stayed what it is at the flight's beginning", LINEAR, CheckId::Distances, Bug::Step(line::AS_CONSTANT)),
    ("free-flight-hole", "σ̂ is zero on a tenth of the ray", FLIGHT, CheckId::Depth, Bug::Setup(hole)),
    ("free-flight-short-ray", "the walk begins and ends a hundredth of the ray inside", FLIGHT, CheckId::Mean, Bug::Setup(short_ray)),
    ("free-flight-first-skipped", "the first collision is never real", FLIGHT, CheckId::Distances, Bug::Step(line::FIRST_SKIPPED)),
    ("free-flight-cap-4", "the fourth collision is always real", FLIGHT, CheckId::Mean, Bug::Step(Slip { ends: Some(|walk, _| (walk.collisions >= 4).then_some(End::Collided)), ..RIGHT })),
    ("free-flight-lookup-before-end-test", "σ_t is looked up before the end is tested: one lookup too many", FLIGHT, CheckId::Lookups, Bug::Step(line::LATE_END)),
    ("free-flight-number-shared", "one random number for the distance and for the decision", FLIGHT, CheckId::Distances, Bug::Step(line::SHARED)),
    ("free-flight-number-stale", "the decision takes the number of the flight before", FLIGHT, CheckId::Lookups, Bug::Step(line::STALE)),
    ("free-flight-number-of-first-decision", "one number for all decisions of a walk", FLIGHT, CheckId::Distances, Bug::Step(line::ONE_FOR_ALL)),
    ("free-flight-from-origin", "distances count from t = 0, not from the ray's beginning", FLIGHT, CheckId::Distances, Bug::Step(Slip { score: Some(|walk, x| if walk.has_left { x } else { x + walk.ray.from }), ..RIGHT })),
    ("free-flight-escape-at-last", "a flight that escapes scores its last collision", FLIGHT, CheckId::Distances, Bug::Step(Slip { score: Some(|walk, x| if walk.has_left { walk.from - walk.ray.from } else { x }), ..RIGHT })),
    ("position-f32", "positions are kept in single precision", FLIGHT, CheckId::Resolution, Bug::Step(Slip { score: Some(position_single), ..RIGHT })),
    ("depth-f32", "the flight's optical depth is computed in single precision", FLIGHT, CheckId::Resolution, Bug::Step(Slip { depth: Some(|_, depth| single(depth)), ..RIGHT })),
    ("uniform-24", "uniform numbers of 24 bits", FLIGHT, CheckId::Resolution, Bug::Step(bits::<24>())),
    ("uniform-15", "uniform numbers of 15 bits, as of an old rand()", FLIGHT, CheckId::Resolution, Bug::Step(bits::<15>())),
];

/// The family.
pub fn mutants() -> Vec<Mutant<FreeFlight>> {
    let draws = |(): &(), bug: &Bug<FreeFlight>| {
        let slip = bug.slip();
        one_by_one(move |setup, medium, random| {
            line::draw(Flights::new(setup), &slip, setup, medium, random)
        })
    };
    on_setups(family(LINES, &Bug::Step(RIGHT), draws), LINES)
}

/// The distance of a collision by positions in single precision.
fn position_single(walk: &Notes, right: f64) -> f64 {
    let from = walk.ray.from;
    if walk.has_left { right } else { single(right + from) - single(from) }
}

/// Uniform numbers that are cut to a number of bits.
const fn bits<const BITS: i32>() -> Slip {
    fn cut<const BITS: i32>(u: f64) -> f64 {
        let scale = f64::exp2(f64::from(BITS));
        (u * scale).floor() / scale
    }
    Slip {
        depth: Some(|walk, _| -Lane::ln(cut::<BITS>(walk.uniform()).one_minus())),
        number: Some(|_, number| cut::<BITS>(number)),
        ..RIGHT
    }
}

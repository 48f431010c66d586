//! Too few bits.
//!
//! ```text
//! u = k/2⁵³, −ln(1 − u) and t in 53 bits
//! ```
//!
//! What is lost is far below any standard error. It is seen at once in the draws themselves: among
//! n distances made of k/2²⁴ about n²/2²⁵ pairs are equal to the last bit, and positions in single
//! precision are all numbers of 24 bits. A weight in single precision breaks the invariant of its walk.

use super::Mutant;
use super::fault::{Fault, RIGHT};
use super::target::{DENSE, FLIGHT};
use super::walk::{flight, product};
use numeric::Lane;
use numeric::rng::{Stream, exponential, unit};
use theory::problems::{FreeFlight, Transmittance};
use theory::rules::Weight;

/// The family's members that estimate the transmittance.
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let bug = "the weight is kept in single precision";
    vec![product("weight-f32", bug, DENSE, "invariant", Weight, WEIGHT_F32)]
}

/// The family's members that sample the free flight.
#[rustfmt::skip] // one mutant, one entry
pub fn flights() -> Vec<Mutant<FreeFlight>> {
    vec![
        flight("position-f32", "positions are kept in single precision", FLIGHT, "resolution", POSITION_F32),
        flight("depth-f32", "the flight's optical depth is computed in single precision", FLIGHT, "resolution", DEPTH_F32),
        flight("uniform-24", "uniform numbers of 24 bits", FLIGHT, "resolution", UNIFORM_24),
        flight("uniform-15", "uniform numbers of 15 bits, as of an old rand()", FLIGHT, "resolution", UNIFORM_15),
    ]
}

#[allow(clippy::cast_possible_truncation)] // the bug
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

const WEIGHT_F32: Fault = Fault { weigh: |_, weight, factor| single(weight * factor), ..RIGHT };

const POSITION_F32: Fault = Fault { distance: |ray, t| single(t) - single(ray.from), ..RIGHT };

const DEPTH_F32: Fault = Fault { flight: |_, rng| single(exponential(rng)), ..RIGHT };

/// `u = ⌊2^24 u⌋/2^24`.
const UNIFORM_24: Fault = Fault {
    flight: |_, rng| -Lane::ln(1.0 - rounded(24, rng)),
    number: |_, rng| rounded(24, rng),
    ..RIGHT
};

/// `u = ⌊2^15 u⌋/2^15`.
const UNIFORM_15: Fault = Fault {
    flight: |_, rng| -Lane::ln(1.0 - rounded(15, rng)),
    number: |_, rng| rounded(15, rng),
    ..RIGHT
};

fn rounded(bits: u32, rng: &mut Stream) -> f64 {
    let scale = f64::from(1_u32 << bits);
    (unit(rng) * scale).floor() / scale
}

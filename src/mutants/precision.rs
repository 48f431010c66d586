//! Too few bits.
//!
//! ```text
//! u = k/2⁵³, −ln(1 − u) and t in 53 bits
//! ```
//!
//! What is lost is far below any standard error. It is seen at once in the draws themselves: among
//! n distances made of k/2²⁴ about n²/2²⁵ pairs are equal to the last bit, and positions in single
//! precision are all numbers of 24 bits. A weight in single precision breaks the books of its walk.

use super::Mutant;
use super::fault::{Fault, Memory};
use super::target::{DENSE, FLIGHT};
use super::walk::{flight, product};
use crate::estimators::rules::Weight;
use crate::numeric::{Lane, Span};
use crate::problems::{FreeFlight, Transmittance};
use crate::rng::{Stream, exponential, unit};

/// The family's members that estimate the transmittance.
#[must_use]
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let bug = "the weight is kept in single precision";
    vec![product("weight-f32", bug, DENSE, "invariant", Weight, WeightF32)]
}

/// The family's members that sample the free flight.
#[must_use]
#[rustfmt::skip] // one mutant, one entry
pub fn flights() -> Vec<Mutant<FreeFlight>> {
    vec![
        flight("position-f32", "positions are kept in single precision", FLIGHT, "resolution", PositionF32),
        flight("depth-f32", "the flight's optical depth is computed in single precision", FLIGHT, "resolution", DepthF32),
        flight("uniform-24", "uniform numbers of 24 bits", FLIGHT, "resolution", Uniform { bits: 24 }),
        flight("uniform-15", "uniform numbers of 15 bits, as of an old rand()", FLIGHT, "resolution", Uniform { bits: 15 }),
    ]
}

#[allow(clippy::cast_possible_truncation)] // the bug
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

#[derive(Clone, Copy)]
struct WeightF32;

impl Fault for WeightF32 {
    #[inline(always)]
    fn weigh(&self, _: &Memory, weight: f64, factor: f64) -> f64 {
        single(weight * factor)
    }
}

#[derive(Clone, Copy)]
struct PositionF32;

impl Fault for PositionF32 {
    #[inline(always)]
    fn distance(&self, ray: Span, t: f64) -> f64 {
        single(t) - single(ray.from)
    }
}

#[derive(Clone, Copy)]
struct DepthF32;

impl Fault for DepthF32 {
    #[inline(always)]
    fn flight(&self, _: &mut Memory, rng: &mut Stream) -> f64 {
        single(exponential(rng))
    }
}

/// `u = ⌊2^bits u⌋/2^bits`.
#[derive(Clone, Copy)]
struct Uniform {
    bits: u32,
}

impl Uniform {
    #[inline(always)]
    fn unit(self, rng: &mut Stream) -> f64 {
        let scale = f64::from(1_u32 << self.bits);
        (unit(rng) * scale).floor() / scale
    }
}

impl Fault for Uniform {
    #[inline(always)]
    fn flight(&self, _: &mut Memory, rng: &mut Stream) -> f64 {
        -Lane::ln(1.0 - self.unit(rng))
    }

    #[inline(always)]
    fn number(&self, _: &mut Memory, rng: &mut Stream) -> f64 {
        self.unit(rng)
    }
}

//! One number as a lane: a double, and single precision.
//!
//! [`F32`] is what a renderer on a graphics card computes with. Every sum, product, quotient and root is
//! rounded to 24 bits. Logarithm, exponential, sine and cosine are the true values rounded once, better
//! than most hardware has them: what single precision costs here is the least it costs anywhere. Tables,
//! lattice hashes and list positions are as in doubles, and their entries are rounded. No draw of a run is
//! made of these; `trueflight-lab stress` compares both.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::words::apart;
use super::{CacheRow, Lane};

/// Adding and subtracting `1.5·2^52` rounds a double of size below `2^51` to the nearest integer.
pub const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// The bits of √½: subtracting them moves the cut between exponents there.
pub const ROOT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;

/// An `f32`, a number of 24 bits.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct F32(pub f32);

/// The place of a number, an integer from 0 to `2^32`, in a list: the last place beyond the last.
#[inline(always)]
pub fn place(number: f64, length: usize) -> usize {
    let [number, _] = apart((number + ROUNDER).to_bits());
    (number as usize).min(length - 1)
}

/// A lane of one number.
pub trait ScalarLane: Lane<Mask = bool> {
    /// Rounds a double to the precision of the lane.
    fn of(x: f64) -> Self;

    /// Returns the number as a double.
    fn double(self) -> f64;
}

impl ScalarLane for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn double(self) -> f64 {
        self
    }
}

#[allow(clippy::cast_possible_truncation)] // to 24 bits
impl ScalarLane for F32 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self(x as f32)
    }

    #[inline(always)]
    fn double(self) -> f64 {
        f64::from(self.0)
    }
}

impl Neg for F32 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! operators {
    ($($Trait:ident::$method:ident),*) => {
        $(
            impl $Trait for F32 {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    Self($Trait::$method(self.0, other.0))
                }
            }

            impl $Trait<f64> for F32 {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: f64) -> Self {
                    $Trait::$method(self, Self::of(other))
                }
            }
        )*
    };
}
operators!(Add::add, Sub::sub, Mul::mul, Div::div);

/// Functions in doubles, with a rounding of their values.
macro_rules! rounded {
    ($($function:ident($($other:ident)?))*) => {
        $(
            #[inline(always)]
            fn $function(self $(, $other: Self)?) -> Self {
                Self::of(Lane::$function(self.double() $(, $other.double())?))
            }
        )*
    };
}

/// What is not arithmetic is done in doubles and rounded.
#[allow(clippy::cast_possible_truncation)] // to 24 bits
impl Lane for F32 {
    type Mask = bool;
    type Words = u64;

    rounded!(ln() exp() cos() sin() cos_pi_size() nearest() power_of_two() alternate(k));

    #[inline(always)]
    fn each(self, value: f64) -> Self {
        Self::of(value)
    }

    #[inline(always)]
    fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
        let mut element = [self.double()];
        replace(&mut element);
        Self::of(element[0])
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        // Rounded once, as such hardware does; a product of two such numbers is exact in a double, and the sum with
        // a third is rounded twice only where that is a tie.
        Self::of(self.double() * factor.double() + term.double())
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn size(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self.0 < other.0
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self.0 <= other.0
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let (m, k) = Lane::split(self.double());
        (Self::of(m), Self::of(k))
    }

    #[inline(always)]
    fn words(self) -> u64 {
        self.double().words()
    }

    #[inline(always)]
    fn where_bits(words: u64, bits: u64, expected: u64, yes: Self, no: Self) -> Self {
        Self::of(f64::where_bits(words, bits, expected, yes.double(), no.double()))
    }

    #[inline(always)]
    fn negated_where(self, words: u64, bit: u32) -> Self {
        Self::of(self.double().negated_where(words, bit))
    }

    #[inline(always)]
    fn entry(self, list: &[f64]) -> Self {
        Self::of(self.double().entry(list))
    }

    #[inline(always)]
    fn columns(self, table: &[CacheRow]) -> [Self; 5] {
        let [a, b, c, d, e] = self.double().columns(table);
        [Self::of(a), Self::of(b), Self::of(c), Self::of(d), Self::of(e)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_operation_is_rounded_to_24_bits() {
        let (one, tiny) = (F32(1.0), F32::of(2f64.powi(-25)));
        assert_eq!((one + tiny).0, 1.0);
        assert_eq!((F32(1.0) / F32(3.0)).0, 1.0f32 / 3.0);
        assert_eq!((F32(16_777_216.0) + 1.0).0, 16_777_216.0);
        assert_eq!(F32(2.0).ln().0, std::f32::consts::LN_2);
        // One rounding: (1 + 2⁻²³)² − 1 keeps its last bit.
        let x = F32(1.0 + f32::EPSILON);
        assert_eq!(x.times_plus(x, -one).0, 2.0 * f32::EPSILON + f32::EPSILON * f32::EPSILON);
    }

    #[test]
    fn a_field_is_looked_up_in_single_precision() {
        use crate::elementary;
        let result = elementary::exp(1.0f64);
        assert!((f64::from(Lane::exp(F32(1.0)).0) - result).abs() < 1.2e-7);
        assert_ne!(f64::from(Lane::exp(F32(1.0)).0), result);
    }
}

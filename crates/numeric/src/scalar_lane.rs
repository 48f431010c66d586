//! One number as a lane: a double in either rounding, and single precision.
//!
//! [`Plain`] rounds a product and its sum apart, as packs do on machines without a fused
//! multiply-add; [`Fused`] rounds them once. Within code that is compiled for such a machine
//! ([`super::fused::in_fused_code`]) that is one instruction, elsewhere a call of the mathematical
//! library: slower, the same bits.
//!
//! [`F32`] is what a renderer on a graphics card computes with. Every sum, product, quotient and root is
//! rounded to 24 bits. Logarithm, exponential, sine and cosine are the true values rounded once, better
//! than most hardware has them: what single precision costs here is the least it costs anywhere. Tables,
//! lattice hashes and list positions are as in doubles, and their entries are rounded. No draw of a run is
//! made of these; `trueflight-lab stress` compares both.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::words::{apart, joined};
use super::{Lane, Row};

/// Adding and subtracting `1.5·2^52` rounds a double of size below `2^51` to the nearest integer.
pub const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// The bits of √½: subtracting them moves the cut between exponents there.
pub const ROOT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;

/// A double with separate roundings of product and sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plain(pub f64);

/// A double with fused multiply-add: one rounding of product and sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fused(pub f64);

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

/// A lane of one number. What is not arithmetic is done in doubles and rounded.
macro_rules! single {
    ($Number:ident($number:ty), |$x:ident, $factor:ident, $term:ident| $times_plus:expr, $($function:ident)*) => {
        single!(operators $Number($number): Add::add, Sub::sub, Mul::mul, Div::div);

        #[allow(clippy::cast_possible_truncation)] // to 24 bits
        impl ScalarLane for $Number {
            #[inline(always)]
            fn of(x: f64) -> Self {
                Self(x as $number)
            }

            #[inline(always)]
            fn double(self) -> f64 {
                f64::from(self.0)
            }
        }

        impl Neg for $Number {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        #[allow(clippy::cast_possible_truncation)] // to 24 bits
        impl Lane for $Number {
            type Mask = bool;
            type Words = u64;

            #[inline(always)]
            fn each(self, value: f64) -> Self {
                Self(value as $number)
            }

            #[inline(always)]
            fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
                let mut element = [f64::from(self.0)];
                replace(&mut element);
                Self(element[0] as $number)
            }

            #[inline(always)]
            fn times_plus(self, $factor: Self, $term: Self) -> Self {
                let $x = self;
                Self($times_plus)
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
            fn nearest(self) -> Self {
                Self(((f64::from(self.0) + ROUNDER) - ROUNDER) as $number)
            }

            #[inline(always)]
            #[allow(clippy::cast_possible_wrap, clippy::cast_sign_loss)] // eleven bits
            fn split(self) -> (Self, Self) {
                let bits = f64::from(self.0).to_bits();
                let k = (bits.wrapping_sub(ROOT_HALF) as i64) >> 52;
                let m = f64::from_bits(bits.wrapping_sub((k as u64) << 52));
                (Self(m as $number), Self(k as $number))
            }

            #[inline(always)]
            fn power_of_two(self) -> Self {
                // The integer stands in the last bits of the sum; 1023 more is its exponent.
                let bits = (f64::from(self.0) + ROUNDER).to_bits();
                Self(f64::from_bits(bits.wrapping_add(1023) << 52) as $number)
            }

            #[inline(always)]
            fn alternate(self, k: Self) -> Self {
                let odd = (f64::from(k.0) + ROUNDER).to_bits() << 63;
                Self(f64::from_bits(f64::from(self.0).to_bits() ^ odd) as $number)
            }

            #[inline(always)]
            fn words(self) -> u64 {
                let [low, _] = apart((f64::from(self.0) + ROUNDER).to_bits());
                joined([low, low])
            }

            #[inline(always)]
            fn where_bits(words: u64, bits: u64, wanted: u64, yes: Self, no: Self) -> Self {
                // Bits, not a branch: what a hash decides cannot be foreseen.
                let mask = u64::from(words & bits == wanted).wrapping_neg();
                let (yes, no) = (f64::from(yes.0).to_bits(), f64::from(no.0).to_bits());
                Self(f64::from_bits(no ^ ((no ^ yes) & mask)) as $number)
            }

            #[inline(always)]
            fn negated_where(self, words: u64, bit: u32) -> Self {
                let sign = words << (63 - bit) & 1 << 63;
                Self(f64::from_bits(f64::from(self.0).to_bits() ^ sign) as $number)
            }

            #[inline(always)]
            fn entry(self, list: &[f64]) -> Self {
                Self(list[place(f64::from(self.0), list.len())] as $number)
            }

            #[inline(always)]
            fn columns(self, table: &[Row]) -> [Self; 5] {
                let [a, b, c, d, e, ..] = table[place(f64::from(self.0), table.len())].0;
                [
                    Self(a as $number),
                    Self(b as $number),
                    Self(c as $number),
                    Self(d as $number),
                    Self(e as $number),
                ]
            }

            $(
                #[inline(always)]
                fn $function(self) -> Self {
                    Self(Lane::$function(f64::from(self.0)) as $number)
                }
            )*
        }
    };
    (operators $Number:ident($number:ty): $($Trait:ident::$method:ident),*) => {
        $(
            impl $Trait for $Number {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    Self($Trait::$method(self.0, other.0))
                }
            }

            #[allow(clippy::cast_possible_truncation)] // to 24 bits
            impl $Trait<f64> for $Number {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: f64) -> Self {
                    Self($Trait::$method(self.0, other as $number))
                }
            }
        )*
    };
}

single!(Plain(f64), |x, factor, term| x.0 * factor.0 + term.0,);
single!(Fused(f64), |x, factor, term| x.0.mul_add(factor.0, term.0),);
// Rounded once, as such hardware does; a product of two such numbers is exact in a double, and the sum with
// a third is rounded twice only where that is a tie.
single!(
    F32(f32),
    |x, factor, term| (f64::from(x.0) * f64::from(factor.0) + f64::from(term.0)) as f32,
    ln exp cos sin cos_pi_size
);

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
        let found = elementary::exp(1.0f64);
        assert!((f64::from(Lane::exp(F32(1.0)).0) - found).abs() < 1.2e-7);
        assert_ne!(f64::from(Lane::exp(F32(1.0)).0), found);
    }
}

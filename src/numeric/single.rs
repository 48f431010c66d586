//! One double as a lane, in either rounding.
//!
//! [`Plain`] rounds a product and its sum apart, as packs do on machines without a fused
//! multiply-add; [`Fused`] rounds them once. Within code that is compiled for such a machine
//! ([`super::pack::in_fused_code`]) that is one instruction, elsewhere a call of the mathematical
//! library: slower, the same bits.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::words::{apart, joined};
use super::{Lane, Row};

/// Adding and subtracting `1.5·2^52` rounds a double of size below `2^51` to the nearest integer.
pub const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// The bits of √½: subtracting them moves the cut between exponents there.
pub const ROOT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;

/// A double whose products and sums are rounded apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plain(pub f64);

/// A double whose products and sums are rounded once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fused(pub f64);

/// The place of a number, an integer from 0 to `2^32`, in a list: the last place beyond the last.
#[inline(always)]
#[must_use]
pub fn place(number: f64, length: usize) -> usize {
    let [number, _] = apart((number + ROUNDER).to_bits());
    (number as usize).min(length - 1)
}

macro_rules! single {
    ($Single:ident, |$x:ident, $factor:ident, $term:ident| $times_plus:expr) => {
        single!(operators $Single: Add::add, Sub::sub, Mul::mul, Div::div);

        impl Neg for $Single {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl Lane for $Single {
            type Mask = bool;
            type Words = u64;

            #[inline(always)]
            fn each(self, value: f64) -> Self {
                Self(value)
            }

            #[inline(always)]
            fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
                let mut element = [self.0];
                replace(&mut element);
                Self(element[0])
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
                Self((self.0 + ROUNDER) - ROUNDER)
            }

            #[inline(always)]
            #[allow(clippy::cast_possible_wrap, clippy::cast_sign_loss)] // eleven bits
            fn split(self) -> (Self, Self) {
                let bits = self.0.to_bits();
                let k = (bits.wrapping_sub(ROOT_HALF) as i64) >> 52;
                let m = f64::from_bits(bits.wrapping_sub((k as u64) << 52));
                (Self(m), Self(k as f64))
            }

            #[inline(always)]
            fn power_of_two(self) -> Self {
                // The integer stands in the last bits of the sum; 1023 more is its exponent.
                let bits = (self.0 + ROUNDER).to_bits();
                Self(f64::from_bits(bits.wrapping_add(1023) << 52))
            }

            #[inline(always)]
            fn alternate(self, k: Self) -> Self {
                let odd = (k.0 + ROUNDER).to_bits() << 63;
                Self(f64::from_bits(self.0.to_bits() ^ odd))
            }

            #[inline(always)]
            fn words(self) -> u64 {
                let [low, _] = apart((self.0 + ROUNDER).to_bits());
                joined([low, low])
            }

            #[inline(always)]
            fn where_bits(words: u64, bits: u64, wanted: u64, yes: Self, no: Self) -> Self {
                // Bits, not a branch: what a hash decides cannot be foreseen.
                let mask = u64::from(words & bits == wanted).wrapping_neg();
                let (yes, no) = (yes.0.to_bits(), no.0.to_bits());
                Self(f64::from_bits(no ^ ((no ^ yes) & mask)))
            }

            #[inline(always)]
            fn negated_where(self, words: u64, bit: u32) -> Self {
                let sign = words << (63 - bit) & 1 << 63;
                Self(f64::from_bits(self.0.to_bits() ^ sign))
            }

            #[inline(always)]
            fn entry(self, list: &[f64]) -> Self {
                Self(list[place(self.0, list.len())])
            }

            #[inline(always)]
            fn columns(self, table: &[Row]) -> [Self; 5] {
                let [a, b, c, d, e, ..] = table[place(self.0, table.len())].0;
                [Self(a), Self(b), Self(c), Self(d), Self(e)]
            }
        }
    };
    (operators $Single:ident: $($Trait:ident::$method:ident),*) => {
        $(
            impl $Trait for $Single {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    Self($Trait::$method(self.0, other.0))
                }
            }

            impl $Trait<f64> for $Single {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: f64) -> Self {
                    Self($Trait::$method(self.0, other))
                }
            }
        )*
    };
}

single!(Plain, |x, factor, term| x.0 * factor.0 + term.0);
single!(Fused, |x, factor, term| x.0.mul_add(factor.0, term.0));

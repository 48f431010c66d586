//! The number type that formulas are written in.
//!
//! A field of a medium is one formula, generic over a lane type: `f64`, or a pack of eight doubles
//! (`pack`) that is treated element by element, or two packs (`pair`). Control flow (loops, early exits) stays
//! outside; within a formula a choice is a [`Lane::select`].
//!
//! Every lane multiplies and adds in one rounding: an element of a pack has the bits that `f64` has, on every machine.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::elementary;
use super::mask::Mask;
use super::scalar_lane::{ROOT_HALF, ROUNDER, place};
use super::words::{Words32, apart, joined};

/// Number of elements of a pack.
pub const WIDTH: usize = 8;

/// A row of a table: one line of the processor's cache.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(align(64))]
pub struct CacheRow(pub [f64; 8]);

/// A double, or a pack of doubles that is treated element by element.
///
/// `ln`, `exp`, `cos` and `sin` are this crate's own polynomials ([`elementary`]).
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// Result of a comparison: true or false for each element.
    type Mask: Mask;

    /// Two 32-bit words in each element.
    type Words: Words32;

    /// Returns a lane of this kind with a value in every element.
    #[must_use]
    fn each(self, value: f64) -> Self;

    /// Replaces the elements, in order, by one call of a function: for lookups, and for functions without a formula for
    /// lanes.
    #[must_use]
    fn replaced(self, replace: impl FnMut(&mut [f64])) -> Self;

    /// Applies a scalar function to each element.
    #[must_use]
    #[inline(always)]
    fn map(self, mut f: impl FnMut(f64) -> f64) -> Self {
        self.replaced(
            #[inline(always)]
            |elements| elements.iter_mut().for_each(|element| *element = f(*element)),
        )
    }

    /// Writes the elements in order to the beginning of a row.
    #[inline(always)]
    fn store(self, row: &mut [f64]) {
        let _ = self.replaced(
            #[inline(always)]
            |elements| row[..elements.len()].copy_from_slice(elements),
        );
    }

    /// Another such lane, of the elements at the beginning of a row.
    #[must_use]
    #[inline(always)]
    fn load(self, row: &[f64]) -> Self {
        self.replaced(
            #[inline(always)]
            |elements| elements.copy_from_slice(&row[..elements.len()]),
        )
    }

    /// Computes in a function of its own where the lane is a pack, and in place elsewhere, see `pack::outlined`.
    #[inline(always)]
    fn outlined<R>(self, compute: impl FnOnce() -> R) -> R {
        compute()
    }

    /// Computes in a function of its own where the lane takes several registers, and in place elsewhere.
    #[inline(always)]
    fn outlined_if_narrow<R>(self, compute: impl FnOnce() -> R) -> R {
        compute()
    }

    /// `self · factor + term`, rounded once.
    #[must_use]
    fn times_plus(self, factor: Self, term: Self) -> Self;

    /// `slope · self + offset`, rounded once.
    #[must_use]
    #[inline(always)]
    fn linear(self, slope: f64, offset: f64) -> Self {
        self.each(slope).times_plus(self, self.each(offset))
    }

    /// `Σ cₙ selfⁿ`.
    #[must_use]
    #[inline(always)]
    fn polynomial<const N: usize>(self, c: &[f64; N]) -> Self {
        elementary::by_pairs(self, c)
    }

    /// `√self`.
    #[must_use]
    fn root(self) -> Self;

    /// `|self|`.
    #[must_use]
    fn size(self) -> Self;

    /// `self < other`.
    fn below(self, other: Self) -> Self::Mask;

    /// `self ≤ other`.
    fn at_most(self, other: Self) -> Self::Mask;

    /// `yes` where the mask says so, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// `self = value`.
    #[inline(always)]
    fn equals(self, value: f64) -> Self::Mask {
        let value = self.each(value);
        self.at_most(value) & value.at_most(self)
    }

    /// Takes another's place where the mask says so.
    #[inline(always)]
    fn set_where(&mut self, which: Self::Mask, other: Self) {
        *self = Self::select(which, other, *self);
    }

    /// Returns the number, and hides from the compiler that it is unchanged.
    ///
    /// Otherwise a choice between a new number and the one in memory that it replaces becomes a masked store. On AVX2
    /// that takes five times as long as a choice and a whole store (Zen 4: 1.7 against 0.35 ns), and a read soon
    /// after takes twice as long (7.8 against 3.9 ns). A number that is sealed before the store is stored as a whole.
    #[must_use]
    #[inline(always)]
    fn sealed(self) -> Self {
        self
    }

    /// [`Self::set_where`] of a number in memory, see [`Self::sealed`].
    #[inline(always)]
    fn keep_where(&mut self, which: Self::Mask, other: Self) {
        *self = Self::select(which, other, *self).sealed();
    }

    /// One of a list. What an index finds lies in memory, and the whole list with it: this finds it among registers.
    #[inline(always)]
    fn one_of<const N: usize>(list: &[Self; N], expected: usize) -> Self {
        let mut chosen = list[0];
        for (number, &entry) in list.iter().enumerate() {
            chosen = if number == expected { entry } else { chosen };
        }
        chosen
    }

    /// One more where the mask says so.
    #[inline(always)]
    fn count_where(&mut self, which: Self::Mask) {
        self.add_where(which, self.each(1.0));
    }

    /// `1 − self`.
    #[must_use]
    #[inline(always)]
    fn one_minus(self) -> Self {
        self.each(1.0) - self
    }

    /// Multiplies where the mask says so.
    #[inline(always)]
    fn scale_where(&mut self, which: Self::Mask, factor: Self) {
        self.set_where(which, *self * factor);
    }

    /// The positive number `self` with the sign of another; the sign of zero is `+`.
    #[must_use]
    #[inline(always)]
    fn with_sign_of(self, other: Self) -> Self {
        Self::select(other.below(self.each(0.0)), -self, self)
    }

    /// Adds where the mask says so.
    #[inline(always)]
    fn add_where(&mut self, which: Self::Mask, term: Self) {
        self.set_where(which, *self + term);
    }

    /// The nearest integer, for `|self| < 2^51`; of two, the even one.
    #[must_use]
    fn nearest(self) -> Self;

    /// The integer below, for `|self| < 2^51`.
    #[must_use]
    #[inline(always)]
    fn floor(self) -> Self {
        let nearest = self.nearest();
        Self::select(self.below(nearest), nearest - 1.0, nearest)
    }

    /// `(m, k)` with `self = m·2^k` and `√½ ≤ m < √2`, for positive normal numbers.
    fn split(self) -> (Self, Self);

    /// `2^self`, for integers from −1022 to 1023.
    #[must_use]
    fn power_of_two(self) -> Self;

    /// `self · (−1)^k`, for integers `|k| < 2^51`.
    #[must_use]
    fn alternate(self, k: Self) -> Self;

    /// The last 32 bits of an integer, `|self| < 2^51`, in both words.
    fn words(self) -> Self::Words;

    /// `yes` where those of an element's 64 bits that are in `bits` are as in `expected`, else `no`.
    fn where_bits(words: Self::Words, bits: u64, expected: u64, yes: Self, no: Self) -> Self;

    /// `self`, negated where the given one of an element's 64 bits is set.
    #[must_use]
    fn negated_where(self, words: Self::Words, bit: u32) -> Self;

    /// Returns the entries of a list at the indices in the elements, integers from 0 to `2^32`; the last entry for
    /// indices beyond it.
    #[must_use]
    fn entry(self, list: &[f64]) -> Self;

    /// Returns the first five columns of the rows of a table at these indices; the last row for indices beyond it.
    fn columns(self, table: &[CacheRow]) -> [Self; 5];

    /// Maximum; `other` if one of the two is NaN.
    #[must_use]
    #[inline(always)]
    fn or_more(self, other: Self) -> Self {
        Self::select(other.below(self), self, other)
    }

    /// Minimum; `other` if one of the two is NaN.
    #[must_use]
    #[inline(always)]
    fn or_less(self, other: Self) -> Self {
        Self::select(self.below(other), self, other)
    }

    /// Natural logarithm of a positive, normal number.
    #[must_use]
    #[inline(always)]
    fn ln(self) -> Self {
        elementary::ln(self)
    }

    /// `e^self`; zero below −708, infinite above 709.
    #[must_use]
    #[inline(always)]
    fn exp(self) -> Self {
        elementary::exp(self)
    }

    /// `cos self`, in radians, `|self| < 1e9`.
    #[must_use]
    #[inline(always)]
    fn cos(self) -> Self {
        elementary::cos(self)
    }

    /// `sin self`, in radians, `|self| < 1e9`.
    #[must_use]
    #[inline(always)]
    fn sin(self) -> Self {
        elementary::sin(self)
    }

    /// `|cos(π self)|`, in half turns, `|self| < 2^51`.
    #[must_use]
    #[inline(always)]
    fn cos_pi_size(self) -> Self {
        elementary::cos_pi_size(self)
    }
}

impl Lane for f64 {
    type Mask = bool;
    type Words = u64;

    #[inline(always)]
    fn each(self, value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
        let mut element = [self];
        replace(&mut element);
        element[0]
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        self.mul_add(factor, term)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn size(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn nearest(self) -> Self {
        (self + ROUNDER) - ROUNDER
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_wrap, clippy::cast_sign_loss)] // eleven bits
    fn split(self) -> (Self, Self) {
        let bits = self.to_bits();
        let k = (bits.wrapping_sub(ROOT_HALF) as i64) >> 52;
        (Self::from_bits(bits.wrapping_sub((k as u64) << 52)), k as Self)
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        // The integer stands in the last bits of the sum; 1023 more is its exponent.
        Self::from_bits((self + ROUNDER).to_bits().wrapping_add(1023) << 52)
    }

    #[inline(always)]
    fn alternate(self, k: Self) -> Self {
        Self::from_bits(self.to_bits() ^ (k + ROUNDER).to_bits() << 63)
    }

    #[inline(always)]
    fn words(self) -> u64 {
        let [low, _] = apart((self + ROUNDER).to_bits());
        joined([low, low])
    }

    #[inline(always)]
    fn where_bits(words: u64, bits: u64, expected: u64, yes: Self, no: Self) -> Self {
        // Bits, not a branch: what a hash decides cannot be foreseen.
        let mask = u64::from(words & bits == expected).wrapping_neg();
        let (yes, no) = (yes.to_bits(), no.to_bits());
        Self::from_bits(no ^ ((no ^ yes) & mask))
    }

    #[inline(always)]
    fn negated_where(self, words: u64, bit: u32) -> Self {
        Self::from_bits(self.to_bits() ^ (words << (63 - bit) & 1 << 63))
    }

    #[inline(always)]
    fn entry(self, list: &[f64]) -> Self {
        list[place(self, list.len())]
    }

    #[inline(always)]
    fn columns(self, table: &[CacheRow]) -> [Self; 5] {
        let [a, b, c, d, e, ..] = table[place(self, table.len())].0;
        [a, b, c, d, e]
    }
}

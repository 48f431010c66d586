//! Two lanes as one: each operation is made on one and then on the other.
//!
//! The operations of a formula wait for each other, and those of the other lane fill the time: a processor
//! looks only so far ahead for work. So polynomials go by Horner's rule here, the longest chain with the
//! fewest operations; all else has the bits that each lane has by itself.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::pack::WIDTH;
use super::words::Words32;
use super::{Lane, Row, elementary};

/// Two lanes.
#[derive(Debug, Clone, Copy)]
pub struct Twin<L>(pub L, pub L);

/// The masks of two lanes, or their words.
#[derive(Debug, Clone, Copy)]
pub struct Both<T>(pub T, pub T);

/// The elements of two packs.
pub const PAIR: usize = 2 * WIDTH;

impl<S: Simd> Twin<f64x8<S>> {
    /// The same value in every element.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self(f64x8::splat(simd, value), f64x8::splat(simd, value))
    }

    /// From a row.
    #[inline(always)]
    pub fn from_slice(simd: S, row: &[f64; PAIR]) -> Self {
        Self(f64x8::from_slice(simd, &row[..WIDTH]), f64x8::from_slice(simd, &row[WIDTH..]))
    }

    /// To a row.
    #[inline(always)]
    pub fn store_slice(&self, row: &mut [f64; PAIR]) {
        self.0.store_slice(&mut row[..WIDTH]);
        self.1.store_slice(&mut row[WIDTH..]);
    }
}

impl<S: Simd> Both<mask64x8<S>> {
    /// As bits.
    #[inline(always)]
    pub fn to_bitmask(self) -> u64 {
        self.0.to_bitmask() | self.1.to_bitmask() << WIDTH
    }
}

macro_rules! operators {
    ($($Operator:ident::$of:ident),*) => {
        $(impl<L: Lane> $Operator for Twin<L> {
            type Output = Self;
            #[inline(always)]
            fn $of(self, other: Self) -> Self {
                Self(self.0.$of(other.0), self.1.$of(other.1))
            }
        })*
    };
    (by a number: $($Operator:ident::$of:ident),*) => {
        $(impl<L: Lane> $Operator<f64> for Twin<L> {
            type Output = Self;
            #[inline(always)]
            fn $of(self, number: f64) -> Self {
                Self(self.0.$of(number), self.1.$of(number))
            }
        })*
    };
}
operators!(Add::add, Sub::sub, Mul::mul, Div::div);
operators!(by a number: Add::add, Sub::sub, Mul::mul);

impl<L: Lane> Neg for Twin<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl<T: BitAnd<Output = T>> BitAnd for Both<T> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0, self.1 & other.1)
    }
}

impl<T: BitOr<Output = T>> BitOr for Both<T> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0, self.1 | other.1)
    }
}

impl<T: Not<Output = T>> Not for Both<T> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0, !self.1)
    }
}

impl<W: Words32> Words32 for Both<W> {
    #[inline(always)]
    fn each(self, words: [u32; 2]) -> Self {
        Self(self.0.each(words), self.1.each(words))
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(self.0.plus(other.0), self.1.plus(other.1))
    }

    #[inline(always)]
    fn times(self, factor: u32) -> Self {
        Self(self.0.times(factor), self.1.times(factor))
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        Self(self.0.xor(other.0), self.1.xor(other.1))
    }

    #[inline(always)]
    fn folded(self, bits: u32) -> Self {
        Self(self.0.folded(bits), self.1.folded(bits))
    }
}

impl<L: Lane> Lane for Twin<L> {
    type Mask = Both<L::Mask>;
    type Words = Both<L::Words>;

    #[inline(always)]
    fn each(self, value: f64) -> Self {
        Self(self.0.each(value), self.1.each(value))
    }

    #[inline(always)]
    fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
        Self(self.0.replaced(&mut replace), self.1.replaced(&mut replace))
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        Self(self.0.times_plus(factor.0, term.0), self.1.times_plus(factor.1, term.1))
    }

    #[inline(always)]
    fn polynomial<const N: usize>(self, c: &[f64; N]) -> Self {
        elementary::horner(self, c)
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.root(), self.1.root())
    }

    #[inline(always)]
    fn size(self) -> Self {
        Self(self.0.size(), self.1.size())
    }

    #[inline(always)]
    fn below(self, other: Self) -> Both<L::Mask> {
        Both(self.0.below(other.0), self.1.below(other.1))
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Both<L::Mask> {
        Both(self.0.at_most(other.0), self.1.at_most(other.1))
    }

    #[inline(always)]
    fn select(mask: Both<L::Mask>, yes: Self, no: Self) -> Self {
        Self(L::select(mask.0, yes.0, no.0), L::select(mask.1, yes.1, no.1))
    }

    #[inline(always)]
    fn nearest(self) -> Self {
        Self(self.0.nearest(), self.1.nearest())
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let ((a, b), (c, d)) = (self.0.split(), self.1.split());
        (Self(a, c), Self(b, d))
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        Self(self.0.power_of_two(), self.1.power_of_two())
    }

    #[inline(always)]
    fn alternate(self, k: Self) -> Self {
        Self(self.0.alternate(k.0), self.1.alternate(k.1))
    }

    #[inline(always)]
    fn words(self) -> Both<L::Words> {
        Both(self.0.words(), self.1.words())
    }

    #[inline(always)]
    fn where_bits(words: Both<L::Words>, bits: u64, wanted: u64, yes: Self, no: Self) -> Self {
        let first = L::where_bits(words.0, bits, wanted, yes.0, no.0);
        Self(first, L::where_bits(words.1, bits, wanted, yes.1, no.1))
    }

    #[inline(always)]
    fn negated_where(self, words: Both<L::Words>, bit: u32) -> Self {
        Self(self.0.negated_where(words.0, bit), self.1.negated_where(words.1, bit))
    }

    #[inline(always)]
    fn entry(self, list: &[f64]) -> Self {
        Self(self.0.entry(list), self.1.entry(list))
    }

    #[inline(always)]
    fn columns(self, table: &[Row]) -> [Self; 5] {
        let ([a, b, c, d, e], [f, g, h, i, j]) = (self.0.columns(table), self.1.columns(table));
        [Self(a, f), Self(b, g), Self(c, h), Self(d, i), Self(e, j)]
    }
}

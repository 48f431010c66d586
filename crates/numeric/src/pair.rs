//! Two lanes as one: each operation is made on one and then on the other.
//!
//! The operations of a formula wait for each other, and those of the other lane fill the time: a processor
//! looks only so far ahead for work. So polynomials go by Horner's rule here, the longest chain with the
//! fewest operations; all else has the bits that each lane has by itself.

use std::ops::{
    Add, BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, BitXorAssign, Div, Mul, Neg, Not, Sub,
};

use super::mask::Mask;
use super::pack::{Hardware, WIDTH};
use super::words::Words32;
use super::{CacheRow, Lane, elementary};

/// Two lanes, or what belongs to them: their masks, their words.
#[derive(Debug, Clone, Copy)]
pub struct Pair<L>(pub L, pub L);

/// The elements of two packs.
pub const PAIR_WIDTH: usize = 2 * WIDTH;

impl<L: Lane> Pair<L> {
    /// A value in every element.
    #[inline(always)]
    pub fn splat<S: Hardware<Pack = L>>(simd: S, value: f64) -> Self {
        Self(simd.splat(value), simd.splat(value))
    }

    /// Loads the elements from a row.
    #[inline(always)]
    pub fn from_row<S: Hardware<Pack = L>>(simd: S, row: &[f64; PAIR_WIDTH]) -> Self {
        let [first, second] = halves(row);
        Self(simd.load(first), simd.load(second))
    }
}

/// The rows of the two packs.
#[inline(always)]
fn halves(row: &[f64; PAIR_WIDTH]) -> [&[f64; WIDTH]; 2] {
    let (halves, _) = row.as_chunks();
    [&halves[0], &halves[1]]
}

/// Operations on one and then on the other, with other lanes and, after a semicolon, with what both share.
macro_rules! both {
    ($($of:ident($($lane:ident),* $(; $shared:ident: $Type:ty)?);)*) => {
        $(
            #[inline(always)]
            fn $of(self $(, $lane: Self)* $(, $shared: $Type)?) -> Self {
                Self(self.0.$of($($lane.0,)* $($shared)?), self.1.$of($($lane.1,)* $($shared)?))
            }
        )*
    };
}

macro_rules! operators {
    ($($Operator:ident::$of:ident($($other:ident)?);)*) => {
        $(impl<T: $Operator<Output = T>> $Operator for Pair<T> {
            type Output = Self;
            both! { $of($($other)?); }
        })*
    };
    (by a number: $($Operator:ident::$of:ident),*) => {
        $(impl<T: $Operator<f64, Output = T>> $Operator<f64> for Pair<T> {
            type Output = Self;
            both! { $of(; number: f64); }
        })*
    };
}
operators! {
    Add::add(other);
    Sub::sub(other);
    Mul::mul(other);
    Div::div(other);
    Neg::neg();
    BitAnd::bitand(other);
    BitOr::bitor(other);
    BitXor::bitxor(other);
    Not::not();
}
operators!(by a number: Add::add, Sub::sub, Mul::mul);

macro_rules! assigned {
    ($($Operator:ident::$of:ident),*) => {
        $(impl<T: $Operator> $Operator for Pair<T> {
            #[inline(always)]
            fn $of(&mut self, other: Self) {
                self.0.$of(other.0);
                self.1.$of(other.1);
            }
        })*
    };
}
assigned!(BitAndAssign::bitand_assign, BitOrAssign::bitor_assign, BitXorAssign::bitxor_assign);

impl<M: Mask> Mask for Pair<M> {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.any() | self.1.any()
    }

    #[inline(always)]
    fn maybe(self) -> bool {
        self.0.maybe() | self.1.maybe()
    }

    #[inline(always)]
    fn are_enough(self, of_pack: u32) -> bool {
        self.bits().count_ones() >= of_pack
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.0.bits() | self.1.bits() << WIDTH
    }

    #[inline(always)]
    fn set_where(&mut self, which: Self, other: Self) {
        self.0.set_where(which.0, other.0);
        self.1.set_where(which.1, other.1);
    }
}

impl<W: Words32> Words32 for Pair<W> {
    both! {
        each(; words: [u32; 2]);
        plus(other);
        times(; factor: u32);
        folded(; bits: u32);
    }
}

impl<L: Lane> Lane for Pair<L> {
    type Mask = Pair<L::Mask>;
    type Words = Pair<L::Words>;

    both! {
        each(; value: f64);
        times_plus(factor, term);
        root();
        size();
        nearest();
        power_of_two();
        alternate(k);
        entry(; list: &[f64]);
    }

    #[inline(always)]
    fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
        Self(self.0.replaced(&mut replace), self.1.replaced(&mut replace))
    }

    #[inline(always)]
    fn store(self, row: &mut [f64]) {
        self.0.store(row);
        self.1.store(&mut row[WIDTH..]);
    }

    #[inline(always)]
    fn load(self, row: &[f64]) -> Self {
        Self(self.0.load(row), self.1.load(&row[WIDTH..]))
    }

    #[inline(always)]
    fn polynomial<const N: usize>(self, c: &[f64; N]) -> Self {
        elementary::horner(self, c)
    }

    #[inline(always)]
    fn below(self, other: Self) -> Pair<L::Mask> {
        Pair(self.0.below(other.0), self.1.below(other.1))
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Pair<L::Mask> {
        Pair(self.0.at_most(other.0), self.1.at_most(other.1))
    }

    #[inline(always)]
    fn select(mask: Pair<L::Mask>, yes: Self, no: Self) -> Self {
        Self(L::select(mask.0, yes.0, no.0), L::select(mask.1, yes.1, no.1))
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let ((a, b), (c, d)) = (self.0.split(), self.1.split());
        (Self(a, c), Self(b, d))
    }

    #[inline(always)]
    fn words(self) -> Pair<L::Words> {
        Pair(self.0.words(), self.1.words())
    }

    #[inline(always)]
    fn where_bits(words: Pair<L::Words>, bits: u64, expected: u64, yes: Self, no: Self) -> Self {
        let first = L::where_bits(words.0, bits, expected, yes.0, no.0);
        Self(first, L::where_bits(words.1, bits, expected, yes.1, no.1))
    }

    #[inline(always)]
    fn negated_where(self, words: Pair<L::Words>, bit: u32) -> Self {
        Self(self.0.negated_where(words.0, bit), self.1.negated_where(words.1, bit))
    }

    #[inline(always)]
    fn columns(self, table: &[CacheRow]) -> [Self; 5] {
        let ([a, b, c, d, e], [f, g, h, i, j]) = (self.0.columns(table), self.1.columns(table));
        [Self(a, f), Self(b, g), Self(c, h), Self(d, i), Self(e, j)]
    }
}

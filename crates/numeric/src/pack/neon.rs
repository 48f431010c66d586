//! Packs on NEON: four registers of two elements each.

use std::sync::atomic::Ordering;

use fearless_simd::{
    Bytes, ExtractToken, Neon, Select, Simd, SimdBase, SimdFloat, SimdInt, SimdMask, f64x4, f64x8,
    i64x8, mask64x8, u32x16, u64x8,
};

use super::{Hardware, PackedWords, WIDTH, ZERO, last, outlined, places};
use crate::rng::xoshiro;
use crate::scalar_lane::{ROOT_HALF, ROUNDER};
use crate::words::joined;
use crate::{CacheRow, Lane, Mask, Words32};

type Pack = f64x8<Neon>;
type Bools = mask64x8<Neon>;
type Words = u64x8<Neon>;

impl Hardware for Neon {
    type Pack = Pack;
    type Mask = Bools;
    type Words = Words;

    const IS_ONE_REGISTER: bool = false;

    #[inline(always)]
    fn splat(self, value: f64) -> Pack {
        SimdBase::splat(self, value)
    }

    #[inline(always)]
    fn load(self, row: &[f64; WIDTH]) -> Pack {
        SimdBase::from_slice(self, row)
    }

    #[inline(always)]
    fn mask(self, bits: u64) -> Bools {
        SimdMask::from_bitmask(self, bits)
    }

    #[inline(always)]
    fn words(self, row: &[u64; WIDTH]) -> Words {
        SimdBase::from_slice(self, row)
    }
}

impl PackedWords for Words {
    type Mask = Bools;

    #[inline(always)]
    fn select(which: Bools, yes: Self, no: Self) -> Self {
        which.select(yes, no)
    }

    #[inline(always)]
    fn uniform_where(which: Bools, state: [Self; 4]) -> ([Self; 4], Pack) {
        super::streams::uniform_where(which, state)
    }

    #[inline(always)]
    fn store(self, row: &mut [u64; WIDTH]) {
        self.store_slice(row);
    }
}

impl xoshiro::Words for Words {
    type Numbers = Pack;

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn upper(self) -> Pack {
        (self >> 11).to_float()
    }
}

#[inline(always)]
fn halves(elements: Words) -> u32x16<Neon> {
    elements.bitcast()
}

impl Words32 for Words {
    #[inline(always)]
    fn each(self, words: [u32; 2]) -> Self {
        SimdBase::splat(self.token(), joined(words))
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        (halves(self) + halves(other)).bitcast()
    }

    #[inline(always)]
    fn times(self, factor: u32) -> Self {
        (halves(self) * factor).bitcast()
    }

    #[inline(always)]
    fn folded(self, bits: u32) -> Self {
        let words = halves(self);
        (words ^ (words >> bits)).bitcast()
    }
}

impl Mask for Bools {
    #[inline(always)]
    fn any(self) -> bool {
        self.any_true()
    }

    #[inline(always)]
    fn maybe(self) -> bool {
        true
    }

    #[inline(always)]
    fn are_enough(self, of_pack: u32) -> bool {
        self.to_bitmask().count_ones() >= of_pack
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.to_bitmask()
    }

    #[inline(always)]
    fn set_where(&mut self, which: Self, other: Self) {
        *self = which.select(other, *self);
    }
}

/// Bits that end in an integer, `|x| < 2^51`.
#[inline(always)]
fn integer(x: Pack) -> Words {
    (x + ROUNDER).bitcast()
}

/// The numbers of entries of a list.
#[inline(always)]
fn within(numbers: Pack, length: usize) -> [usize; WIDTH] {
    let words: u32x16<Neon> = integer(numbers).bitcast();
    let within: Words = words.min(last(length)).bitcast();
    places(within)
}

/// The first four entries of two rows side by side.
#[inline(always)]
fn two_rows(simd: Neon, first: &CacheRow, second: &CacheRow) -> Pack {
    let low = f64x4::from_slice(simd, &first.0[..4]);
    simd.combine_f64x4(low, f64x4::from_slice(simd, &second.0[..4]))
}

impl Lane for Pack {
    type Mask = Bools;
    type Words = Words;

    #[inline(always)]
    fn sealed(self) -> Self {
        let zero: Words = SimdBase::splat(self.token(), ZERO.load(Ordering::Relaxed));
        let bits: Words = self.bitcast();
        (bits | zero).bitcast()
    }

    #[inline(always)]
    fn each(self, value: f64) -> Self {
        SimdBase::splat(self.token(), value)
    }

    #[inline(always)]
    fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
        let mut elements = [0.0; WIDTH];
        self.store_slice(&mut elements);
        replace(&mut elements);
        Self::from_slice(self.token(), &elements)
    }

    #[inline(always)]
    fn store(self, row: &mut [f64]) {
        self.store_slice(&mut row[..WIDTH]);
    }

    #[inline(always)]
    fn load(self, row: &[f64]) -> Self {
        Self::from_slice(self.token(), &row[..WIDTH])
    }

    #[inline(always)]
    fn outlined<R>(self, compute: impl FnOnce() -> R) -> R {
        outlined(self.token(), compute)
    }

    #[inline(always)]
    fn outlined_if_narrow<R>(self, compute: impl FnOnce() -> R) -> R {
        outlined(self.token(), compute)
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
    fn below(self, other: Self) -> Bools {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Bools {
        self.simd_le(other)
    }

    #[inline(always)]
    fn select(mask: Bools, yes: Self, no: Self) -> Self {
        mask.select(yes, no)
    }

    #[inline(always)]
    fn nearest(self) -> Self {
        self.round_ties_even()
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits: Words = self.bitcast();
        let shifted: i64x8<Neon> = (bits - ROOT_HALF).bitcast();
        let exponent = shifted >> 52;
        let k: Words = exponent.bitcast();
        ((bits - (k << 52)).bitcast(), exponent.to_float())
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        ((integer(self) + 1023) << 52).bitcast()
    }

    #[inline(always)]
    fn alternate(self, k: Self) -> Self {
        let bits: Words = self.bitcast();
        (bits ^ (integer(k) << 63)).bitcast()
    }

    #[inline(always)]
    fn words(self) -> Words {
        let bits = integer(self);
        (bits & 0xffff_ffff) | (bits << 32)
    }

    #[inline(always)]
    fn where_bits(words: Words, bits: u64, expected: u64, yes: Self, no: Self) -> Self {
        (words & bits).simd_eq(expected).select(yes, no)
    }

    #[inline(always)]
    fn negated_where(self, words: Words, bit: u32) -> Self {
        let bits: Words = self.bitcast();
        (bits ^ ((words << (63 - bit)) & 1 << 63)).bitcast()
    }

    #[inline(always)]
    fn entry(self, list: &[f64]) -> Self {
        let [a, b, c, d, e, f, g, h] = within(self, list.len());
        let row = [list[a], list[b], list[c], list[d], list[e], list[f], list[g], list[h]];
        Self::from_slice(self.token(), &row)
    }

    #[inline(always)]
    fn columns(self, table: &[CacheRow]) -> [Self; 5] {
        let (simd, [a, b, c, d, e, f, g, h]) = (self.token(), within(self, table.len()));
        let (a, b, c, d) = (&table[a], &table[b], &table[c], &table[d]);
        let (e, f, g, h) = (&table[e], &table[f], &table[g], &table[h]);
        let fifth = [a.0[4], b.0[4], c.0[4], d.0[4], e.0[4], f.0[4], g.0[4], h.0[4]];
        let (a, b) = (two_rows(simd, a, b), two_rows(simd, c, d));
        let (c, d) = (two_rows(simd, e, f), two_rows(simd, g, h));
        // Columns 0 and 2 from columns 1 and 3, then each by itself.
        let (even_low, odd_low) = simd.deinterleave_f64x8(a, b);
        let (even_high, odd_high) = simd.deinterleave_f64x8(c, d);
        let (first, third) = simd.deinterleave_f64x8(even_low, even_high);
        let (second, fourth) = simd.deinterleave_f64x8(odd_low, odd_high);
        [first, second, third, fourth, Self::from_slice(simd, &fifth)]
    }
}

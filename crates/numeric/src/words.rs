//! Two 32-bit words in each element of a lane: what lattices are hashed with.
//!
//! A register of eight doubles holds sixteen such words, so that the hashes of two lattice points
//! are made at the cost of one. All arithmetic is modulo `2^32` in each word.

use std::ops::BitXor;

/// Two 32-bit words, or a pack of such pairs that is treated element by element.
pub trait Words32: Copy + BitXor<Output = Self> {
    /// Returns a lane of this kind with two words, the lower one first, in every element.
    #[must_use]
    fn each(self, words: [u32; 2]) -> Self;
    /// The sums.
    #[must_use]
    fn plus(self, other: Self) -> Self;
    /// The products with one factor.
    #[must_use]
    fn times(self, factor: u32) -> Self;
    /// Each word, exclusive or itself shifted right.
    #[must_use]
    fn folded(self, bits: u32) -> Self;
}

/// The bits of an element with these two words.
#[inline(always)]
pub fn joined([low, high]: [u32; 2]) -> u64 {
    u64::from(low) | u64::from(high) << 32
}

/// The two words of an element.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // the halves
pub fn apart(element: u64) -> [u32; 2] {
    [element as u32, (element >> 32) as u32]
}

impl Words32 for u64 {
    #[inline(always)]
    fn each(self, words: [u32; 2]) -> Self {
        joined(words)
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (apart(self), apart(other));
        joined([a.wrapping_add(c), b.wrapping_add(d)])
    }

    #[inline(always)]
    fn times(self, factor: u32) -> Self {
        let [a, b] = apart(self);
        joined([a.wrapping_mul(factor), b.wrapping_mul(factor)])
    }

    #[inline(always)]
    fn folded(self, bits: u32) -> Self {
        let [a, b] = apart(self);
        joined([a ^ a >> bits, b ^ b >> bits])
    }
}

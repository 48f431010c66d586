//! Words in packs: sixteen in a register of 512 bits.

use fearless_simd::{Bytes, ExtractToken, Simd, SimdBase, u32x16, u64x8};

use crate::words::{Words32, joined};

#[inline(always)]
fn words<S: Simd>(elements: u64x8<S>) -> u32x16<S> {
    elements.bitcast()
}

impl<S: Simd> Words32 for u64x8<S> {
    #[inline(always)]
    fn each(self, words: [u32; 2]) -> Self {
        SimdBase::splat(self.token(), joined(words))
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        (words(self) + words(other)).bitcast()
    }

    #[inline(always)]
    fn times(self, factor: u32) -> Self {
        (words(self) * factor).bitcast()
    }

    #[inline(always)]
    fn folded(self, bits: u32) -> Self {
        let words = words(self);
        (words ^ (words >> bits)).bitcast()
    }
}

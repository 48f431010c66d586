//! Numbers of eight walks that are kept from step to step, and replaced for some of them.
//!
//! A choice between a new number and the one that it is written over becomes a masked store. On AVX2 that takes five times
//! as long as a choice and a whole store, and what is read soon after waits twice as long (Zen 4: 1.7 against .35 ns, 7.8
//! against 3.9). So bits are added that are 0 and that the compiler does not know.

use fearless_simd::{Bytes, Simd, SimdBase, f64x8, mask64x8, u64x8};

use numeric::Lane;
use numeric::pack::converts;

/// Writes what is kept.
#[derive(Clone, Copy)]
pub struct Keep<S: Simd> {
    simd: S,
    nothing: u64x8<S>,
}

impl<S: Simd> Keep<S> {
    /// Once for all walks.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        Self { simd, nothing: u64x8::splat(simd, std::hint::black_box(0)) }
    }

    /// Replaces what is kept where a mask says so.
    #[inline(always)]
    pub fn put(self, kept: &mut f64x8<S>, which: mask64x8<S>, new: f64x8<S>) {
        let chosen = Lane::select(which, new, *kept);
        if converts(self.simd) {
            *kept = chosen;
            return;
        }
        let bits: u64x8<S> = chosen.bitcast();
        *kept = (bits | self.nothing).bitcast();
    }
}

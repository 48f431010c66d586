//! xoshiro256+, one stream or eight side by side.
//!
//! ```text
//! out = s₀ + s₃;  t = s₁ ≪ 17
//! s₂ ^= s₀;  s₃ ^= s₁;  s₁ ^= s₂;  s₀ ^= s₃;  s₂ ^= t;  s₃ = rotl(s₃, 45)
//! ```
//!
//! Additions, shifts and exclusive ors: what a vector unit does well. Element i of a pack of
//! streams has the words of stream i. Numbers are made of a word's upper 53 bits: the lowest three are
//! those of a linear generator.
//!
//! Source: D. Blackman, S. Vigna, *Scrambled linear pseudorandom number generators*, ACM
//! Transactions on Mathematical Software 47(4) (2021).

use std::convert::Infallible;
use std::ops::{BitOr, BitXor, Shl, Shr};

use rand_core::TryRng;

use crate::Lane;

/// `2^-53`, the distance between uniform numbers.
pub const SCALE: f64 = 1.0 / (1_u64 << 53) as f64;

/// A 64-bit word, or a pack of words that is treated element by element.
pub trait Words:
    Copy
    + BitXor<Output = Self>
    + BitOr<Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
{
    /// The numbers made of such words.
    type Numbers: Lane;

    /// The sum modulo `2^64`.
    #[must_use]
    fn plus(self, other: Self) -> Self;
    /// The upper 53 bits as an integer.
    fn upper(self) -> Self::Numbers;

    /// See [`next`].
    #[inline(always)]
    fn next(state: [Self; 4]) -> ([Self; 4], Self) {
        next(state)
    }
}

/// The state after one, and the word.
#[inline(always)]
pub fn next<W: Words>([s0, s1, s2, s3]: [W; 4]) -> ([W; 4], W) {
    let word = s0.plus(s3);
    let (s2, s3) = (s2 ^ s0, s3 ^ s1);
    ([s0 ^ s3, s1 ^ s2, s2 ^ (s1 << 17), (s3 << 45) | (s3 >> 19)], word)
}

impl Words for u64 {
    type Numbers = f64;

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self.wrapping_add(other)
    }

    #[inline(always)]
    fn upper(self) -> f64 {
        (self >> 11) as f64
    }
}

/// The generator: one stream for `u64`, eight for a pack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Xoshiro<W> {
    pub(crate) state: [W; 4],
}

impl<W: Words> Xoshiro<W> {
    /// Generator at a state, which must not be zero.
    #[inline(always)]
    pub fn at(state: [W; 4]) -> Self {
        Self { state }
    }

    /// State of the generator; [`Self::at`] continues from it.
    #[inline(always)]
    pub fn state(&self) -> [W; 4] {
        self.state
    }

    /// The next word.
    #[inline(always)]
    pub fn word(&mut self) -> W {
        let (state, word) = W::next(self.state);
        self.state = state;
        word
    }

    /// Uniform among the integers below `2^53`.
    #[inline(always)]
    pub fn integer(&mut self) -> W::Numbers {
        self.word().upper()
    }

    /// Uniform in `[0, 1)`, all 53 bits: for decisions, `uniform() < p` has probability `p`.
    #[inline(always)]
    pub fn uniform(&mut self) -> W::Numbers {
        self.integer() * SCALE
    }

    /// Uniform in `(0, 1]`: its logarithm is finite.
    #[inline(always)]
    pub fn positive_uniform(&mut self) -> W::Numbers {
        let upper = self.integer();
        // The product is exact, fused or not.
        upper.times_plus(upper.each(-SCALE), upper.each(1.0))
    }

    /// `ln u` with `u` uniform in `(0, 1]`: minus an exponential with mean 1.
    #[inline(always)]
    pub fn ln_uniform(&mut self) -> W::Numbers {
        self.positive_uniform().ln()
    }
}

impl TryRng for Xoshiro<u64> {
    type Error = Infallible;

    #[inline]
    #[allow(clippy::cast_possible_truncation)] // the upper half
    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        Ok((self.word() >> 32) as u32)
    }

    #[inline]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        Ok(self.word())
    }

    #[inline]
    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for chunk in bytes.chunks_mut(8) {
            chunk.copy_from_slice(&self.word().to_le_bytes()[..chunk.len()]);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_the_authors_code() {
        // What the authors' xoshiro256plus.c prints for the state 1, 2, 3, 4.
        let mut stream = Xoshiro::at([1_u64, 2, 3, 4]);
        for word in [
            5,
            211_106_232_532_999,
            211_106_635_186_183,
            9_223_759_065_350_669_058,
            9_250_833_439_874_351_877,
            13_862_484_359_527_728_515,
            2_346_507_365_006_083_650,
            1_168_864_526_675_804_870,
            34_095_955_243_042_024,
            3_466_914_240_207_415_127,
        ] {
            assert_eq!(stream.word(), word);
        }
    }
}

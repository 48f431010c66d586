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

use fearless_simd::{Bytes, ExtractToken, Select, Simd, SimdBase, SimdInt, f64x8, mask64x8, u64x8};
use rand::TryRng;

use crate::Lane;
use crate::pack::{self, WIDTH};

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

impl<S: Simd> Words for u64x8<S> {
    type Numbers = f64x8<S>;

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn upper(self) -> f64x8<S> {
        let word = self >> 11;
        if pack::converts(self.token()) {
            return word.to_float();
        }
        // Each half becomes the last bits of a double, above 2^84 and 2^52; all steps are exact.
        let (above, below) = (2f64.powi(84), 2f64.powi(52));
        let high: f64x8<S> = ((word >> 32) | above.to_bits()).bitcast();
        let low: f64x8<S> = ((word & 0xffff_ffff) | below.to_bits()).bitcast();
        (high - (above + below)) + low
    }
}

/// The generator: one stream for `u64`, eight for a pack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Xoshiro<W> {
    state: [W; 4],
}

impl<W: Words> Xoshiro<W> {
    /// At a state, which must not be zero.
    #[inline(always)]
    pub fn at(state: [W; 4]) -> Self {
        Self { state }
    }

    /// Where it stands: [`Self::at`] goes on from there.
    #[inline(always)]
    pub fn state(&self) -> [W; 4] {
        self.state
    }

    /// The next word.
    #[inline(always)]
    pub fn word(&mut self) -> W {
        let [s0, s1, s2, s3] = self.state;
        let word = s0.plus(s3);
        let (s2, s3) = (s2 ^ s0, s3 ^ s1);
        self.state = [s0 ^ s3, s1 ^ s2, s2 ^ (s1 << 17), (s3 << 45) | (s3 >> 19)];
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

/// Eight streams side by side, between two kernels.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Lanes([[u64; WIDTH]; 4]);

impl Lanes {
    /// The streams side by side.
    pub fn of(streams: &[Xoshiro<u64>; WIDTH]) -> Self {
        let word = |word: usize, lane: usize| streams[lane].state[word];
        Self(std::array::from_fn(|i| std::array::from_fn(|lane| word(i, lane))))
    }

    /// Each of the streams by itself.
    pub fn apart(&self) -> [Xoshiro<u64>; WIDTH] {
        std::array::from_fn(|lane| Xoshiro { state: self.0.map(|words| words[lane]) })
    }

    /// In the hardware's registers.
    #[inline(always)]
    pub fn awake<S: Simd>(&self, simd: S) -> Xoshiro<u64x8<S>> {
        let [a, b, c, d] = &self.0;
        Xoshiro {
            state: [
                u64x8::from_slice(simd, a),
                u64x8::from_slice(simd, b),
                u64x8::from_slice(simd, c),
                u64x8::from_slice(simd, d),
            ],
        }
    }
}

impl<S: Simd> Xoshiro<u64x8<S>> {
    /// Uniform in `[0, 1)` from the streams that a mask names: the others stay where they are, and
    /// their numbers mean nothing.
    #[inline(always)]
    pub fn uniform_where(&mut self, mask: mask64x8<S>) -> f64x8<S> {
        let [a, b, c, d] = self.state;
        let number = self.uniform();
        let [e, f, g, h] = self.state;
        self.state = [mask.select(e, a), mask.select(f, b), mask.select(g, c), mask.select(h, d)];
        number
    }

    /// The same of [`Self::ln_uniform`].
    #[inline(always)]
    pub fn ln_uniform_where(&mut self, mask: mask64x8<S>) -> f64x8<S> {
        // `1 − u` is exact, as it is in `positive_uniform`.
        let number = self.uniform_where(mask);
        (number.each(1.0) - number).ln()
    }

    /// Where the streams stand.
    #[inline(always)]
    pub fn at_rest(self) -> Lanes {
        // One by one: a reference to the state would keep it out of the registers.
        let [a, b, c, d] = self.state;
        let mut lanes = Lanes([[0; WIDTH]; 4]);
        a.store_slice(&mut lanes.0[0]);
        b.store_slice(&mut lanes.0[1]);
        c.store_slice(&mut lanes.0[2]);
        d.store_slice(&mut lanes.0[3]);
        lanes
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
    use fearless_simd::Level;

    use super::*;
    use crate::pack::{Task, on};

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

    struct Drawn([Xoshiro<u64>; WIDTH]);
    impl Task for Drawn {
        type Output = ([[f64; WIDTH]; 3], [Xoshiro<u64>; WIDTH]);
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            let mut streams = Lanes::of(&self.0).awake(simd);
            let numbers = [streams.uniform(), streams.positive_uniform(), streams.ln_uniform()];
            let mut rows = [[0.0; WIDTH]; 3];
            for (row, number) in rows.iter_mut().zip(numbers) {
                number.store_slice(row);
            }
            (rows, streams.at_rest().apart())
        }
    }

    #[test]
    fn streams_side_by_side_are_the_streams() {
        let mut seed = Xoshiro::at([5_u64, 6, 7, 8]);
        for _ in 0..200 {
            let mut alone = [Xoshiro::at([0; 4]); WIDTH];
            for stream in &mut alone {
                *stream = Xoshiro::at([seed.word(), seed.word(), seed.word(), seed.word()]);
            }
            for level in [Level::new(), Level::baseline()] {
                let mut alone = alone;
                let (rows, after) = on(level, Drawn(alone));
                for (lane, stream) in alone.iter_mut().enumerate() {
                    assert_eq!(rows[0][lane], stream.uniform());
                    assert_eq!(rows[1][lane], stream.positive_uniform());
                    // The baseline rounds apart what this machine's scalars may fuse.
                    assert!((rows[2][lane] - stream.ln_uniform()).abs() <= 1e-14);
                    assert_eq!(after[lane], *stream);
                }
            }
        }
    }
}

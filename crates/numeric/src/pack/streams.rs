//! Streams of random numbers side by side, in packs.

use fearless_simd::{Bytes, ExtractToken, Select, Simd, SimdBase, SimdInt, f64x8, mask64x8, u64x8};

use super::{WIDTH, converts};
use crate::Lane;
use crate::rng::xoshiro::Words;
use crate::rng::{PACKS, Random, Streams, Xoshiro};

impl<S: Simd> Words for u64x8<S> {
    type Numbers = f64x8<S>;

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn upper(self) -> f64x8<S> {
        let word = self >> 11;
        if converts(self.token()) {
            return word.to_float();
        }
        // Each half becomes the last bits of a double, above 2^84 and 2^52; all steps are exact.
        let (above, below) = (2f64.powi(84), 2f64.powi(52));
        let high: f64x8<S> = ((word >> 32) | above.to_bits()).bitcast();
        let low: f64x8<S> = ((word & 0xffff_ffff) | below.to_bits()).bitcast();
        (high - (above + below)) + low
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
        std::array::from_fn(|lane| Xoshiro::at(self.0.map(|words| words[lane])))
    }

    /// Loads the streams into vector registers.
    #[inline(always)]
    pub fn awake<S: Simd>(&self, simd: S) -> Xoshiro<u64x8<S>> {
        let [a, b, c, d] = &self.0;
        Xoshiro::at([
            u64x8::from_slice(simd, a),
            u64x8::from_slice(simd, b),
            u64x8::from_slice(simd, c),
            u64x8::from_slice(simd, d),
        ])
    }
}

impl<S: Simd> Xoshiro<u64x8<S>> {
    /// States of the streams, in memory.
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

impl Streams {
    /// The streams, pack by pack.
    pub fn packs(&self) -> [Lanes; PACKS] {
        let (packs, _) = self.lanes.as_chunks();
        std::array::from_fn(|pack| Lanes::of(&packs[pack]))
    }
}

impl<S: Simd> Random<f64x8<S>> for Xoshiro<u64x8<S>> {
    #[inline(always)]
    fn uniform(&mut self) -> f64x8<S> {
        Xoshiro::uniform(self)
    }

    #[inline(always)]
    fn ln_uniform(&mut self) -> f64x8<S> {
        Xoshiro::ln_uniform(self)
    }

    #[inline(always)]
    fn uniform_where(&mut self, which: mask64x8<S>) -> f64x8<S> {
        let [a, b, c, d] = self.state;
        let number = Xoshiro::uniform(self);
        let [e, f, g, h] = self.state;
        self.state =
            [which.select(e, a), which.select(f, b), which.select(g, c), which.select(h, d)];
        number
    }

    #[inline(always)]
    fn ln_uniform_where(&mut self, which: mask64x8<S>) -> f64x8<S> {
        // `1 − u` is exact, as it is in `positive_uniform`.
        let number = self.uniform_where(which);
        (number.each(1.0) - number).ln()
    }
}

#[cfg(test)]
mod tests {
    use fearless_simd::Level;

    use super::*;
    use crate::pack::{Task, on};

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

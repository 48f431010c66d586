//! Streams of random numbers side by side, in packs.

use super::{Hardware, PackedWords, WIDTH};
use crate::Lane;
use crate::rng::{PACKS, Random, Streams, Xoshiro};

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
    pub fn awake<S: Hardware>(&self, simd: S) -> Xoshiro<S::Words> {
        let [a, b, c, d] = &self.0;
        Xoshiro::at([simd.words(a), simd.words(b), simd.words(c), simd.words(d)])
    }
}

impl<W: PackedWords> Xoshiro<W> {
    /// States of the streams, in memory.
    #[inline(always)]
    pub fn at_rest(self) -> Lanes {
        // One by one: a reference to the state would keep it out of the registers.
        let [a, b, c, d] = self.state;
        let mut lanes = Lanes([[0; WIDTH]; 4]);
        a.store(&mut lanes.0[0]);
        b.store(&mut lanes.0[1]);
        c.store(&mut lanes.0[2]);
        d.store(&mut lanes.0[3]);
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

/// The states after uniform numbers for the elements that a mask selects, and the numbers.
#[inline(always)]
pub(super) fn uniform_where<W: PackedWords>(
    which: W::Mask,
    [a, b, c, d]: [W; 4],
) -> ([W; 4], W::Numbers) {
    let mut streams = Xoshiro::at([a, b, c, d]);
    let number = Xoshiro::uniform(&mut streams);
    let [e, f, g, h] = streams.state;
    let state = [
        W::select(which, e, a),
        W::select(which, f, b),
        W::select(which, g, c),
        W::select(which, h, d),
    ];
    (state, number)
}

impl<W: PackedWords> Random<W::Numbers> for Xoshiro<W> {
    #[inline(always)]
    fn uniform(&mut self) -> W::Numbers {
        Xoshiro::uniform(self)
    }

    #[inline(always)]
    fn ln_uniform(&mut self) -> W::Numbers {
        Xoshiro::ln_uniform(self)
    }

    #[inline(always)]
    fn uniform_where(&mut self, which: W::Mask) -> W::Numbers {
        let (state, number) = W::uniform_where(which, self.state);
        self.state = state;
        number
    }

    #[inline(always)]
    fn ln_uniform_where(&mut self, which: W::Mask) -> W::Numbers {
        // `1 − u` is exact, as it is in `positive_uniform`.
        let number = self.uniform_where(which);
        (number.each(1.0) - number).ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pack::{Task, levels, on};

    struct DrawnWords([Xoshiro<u64>; WIDTH]);
    impl Task for DrawnWords {
        type Output = ([[f64; WIDTH]; 3], [Xoshiro<u64>; WIDTH]);
        #[inline(always)]
        fn run<S: Hardware>(self, simd: S) -> Self::Output {
            let mut streams = Lanes::of(&self.0).awake(simd);
            let numbers = [streams.uniform(), streams.positive_uniform(), streams.ln_uniform()];
            let mut rows = [[0.0; WIDTH]; 3];
            for (row, number) in rows.iter_mut().zip(numbers) {
                number.store(row);
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
            for level in levels() {
                let mut alone = alone;
                let Ok((rows, after)) = on(level, DrawnWords(alone)) else { continue };
                for (lane, stream) in alone.iter_mut().enumerate() {
                    assert_eq!(rows[0][lane], stream.uniform());
                    assert_eq!(rows[1][lane], stream.positive_uniform());
                    assert_eq!(rows[2][lane], stream.ln_uniform());
                    assert_eq!(after[lane], *stream);
                }
            }
        }
    }
}

//! Random numbers by address.
//!
//! Every random number of a run has an address: (seed, experiment, block, lane) names a stream,
//! and the position in the stream is fixed by the draw. Threads, shards and machines are no part
//! of it, so that any number of them makes the same draws.
//!
//! A block has [`LANES`] streams, and draw j of the block comes from stream j mod [`LANES`]: for
//! every estimator, whether it draws one by one or in packs.

pub mod xoshiro;

use rand_core::Rng;
use rand_pcg::Pcg64;

use crate::{Lane, ScalarLane, lane::WIDTH};

pub use xoshiro::Xoshiro;

/// The generator of one stream of draws: xoshiro256+.
pub type Stream = Xoshiro<u64>;

/// Random numbers for each element of a lane: from one stream for a scalar, from eight for a pack.
pub trait Random<L: Lane> {
    /// Uniform in `[0, 1)`.
    fn uniform(&mut self) -> L;

    /// `ln u` with `u` uniform in `(0, 1]`: minus an exponential with mean 1.
    fn ln_uniform(&mut self) -> L;

    /// Uniform numbers for the elements that a mask selects. The streams of the others do not change, and their numbers
    /// have no meaning.
    fn uniform_where(&mut self, which: L::Mask) -> L;

    /// Numbers of [`Self::ln_uniform`] for the elements that a mask selects, as in [`Self::uniform_where`].
    fn ln_uniform_where(&mut self, which: L::Mask) -> L;
}

impl<L: ScalarLane> Random<L> for Stream {
    #[inline(always)]
    fn uniform(&mut self) -> L {
        L::of(Xoshiro::uniform(self))
    }

    #[inline(always)]
    fn ln_uniform(&mut self) -> L {
        // `1 − u` is exact.
        Lane::ln(L::of(1.0 - Xoshiro::uniform(self)))
    }

    #[inline(always)]
    fn uniform_where(&mut self, which: bool) -> L {
        L::of(if which { Xoshiro::uniform(self) } else { 0.0 })
    }

    #[inline(always)]
    fn ln_uniform_where(&mut self, which: bool) -> L {
        if which { Random::ln_uniform(self) } else { L::of(0.0) }
    }
}

/// The packs of streams of a block: a step of a walk waits for the one before it, and the steps of a second
/// pack fill that time.
pub const PACKS: usize = 2;

/// The streams of a block.
pub const LANES: usize = PACKS * WIDTH;

/// Address of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Address {
    /// The run's seed.
    pub seed: u64,
    /// The experiment's name, hashed by [`name_hash`].
    pub experiment: u64,
    /// The block of draws within the experiment; [`PILOT`] for draws before the first.
    pub block: u64,
    /// The lane within the block: below [`LANES`] for draws, [`PILOT`] for pilot rays.
    pub lane: u64,
}

/// No block and no lane of draws: what is drawn before the first draw is found here.
pub const PILOT: u64 = u64::MAX;

impl Address {
    /// The generator that seeds a stream, and that pilot rays use: PCG XSL RR 128/64.
    ///
    /// The whole address is hashed into both the state and the increment: PCG streams that differ
    /// in the stream word only may be correlated.
    ///
    /// Source: M. E. O'Neill, *PCG: A family of simple fast space-efficient statistically good
    /// algorithms for random number generation*, Harvey Mudd College HMC-CS-2014-0905 (2014).
    fn seeder(self) -> Pcg64 {
        let mut hash = 0x7472_7565_666c_6967; // "trueflig": keeps seed 0 away from state 0
        for word in [self.seed, self.experiment, self.block, self.lane] {
            hash = mix(hash ^ word);
        }
        let mut word = || {
            hash = hash.wrapping_add(0x9e37_79b9_7f4a_7c15);
            u128::from(mix(hash))
        };
        let state = word() << 64 | word();
        let increment = word() << 64 | word();
        Pcg64::new(state, increment)
    }

    /// The generator of a pilot ray, which learns a sampling extinction before the first draw.
    pub fn pilot(self) -> Pcg64 {
        Self { lane: PILOT, ..self }.seeder()
    }

    /// The stream at its beginning.
    pub fn stream(self) -> Stream {
        let mut seeder = self.seeder();
        let mut word = || seeder.next_u64();
        Stream::at([word(), word(), word(), word()])
    }

    /// The streams of the block, at their beginnings.
    pub fn streams(self) -> Streams {
        let stream = |lane: usize| Self { lane: lane as u64, ..self }.stream();
        Streams { lanes: std::array::from_fn(stream), turn: 0 }
    }
}

/// The streams of a block, and the lane of the next draw.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Streams {
    /// The streams, each where its last draw left it.
    pub lanes: [Stream; LANES],
    /// The lane of the next draw; the first draw comes from the first.
    pub turn: usize,
}

impl Streams {
    /// The stream of the next draw.
    #[inline(always)]
    pub fn of_next_draw(&mut self) -> &mut Stream {
        let lane = self.turn;
        self.turn = (lane + 1) % LANES;
        &mut self.lanes[lane]
    }

    /// The next word of each lane in turn, for tests of the streams themselves.
    pub fn words(mut self) -> impl Iterator<Item = u64> {
        std::iter::from_fn(move || Some(self.of_next_draw().word()))
    }
}

/// The finaliser of `SplitMix64` (S. Vigna, after G. Steele, D. Lea, C. Flood, *Fast splittable
/// pseudorandom number generators*, OOPSLA 2014), a bijection of 64-bit words.
#[inline(always)]
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// FNV-1a of a name, mixed: an experiment keeps its streams when others join or leave the run.
pub fn name_hash(name: &str) -> u64 {
    hash(name.as_bytes())
}

/// A 64-bit hash of any bytes.
pub fn hash(bytes: &[u8]) -> u64 {
    let fnv = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    mix(bytes.iter().fold(0xcbf2_9ce4_8422_2325, fnv))
}

/// Uniform in `[0, 1)`, all 53 bits: for decisions, `unit(rng) < p` has probability `p`.
#[inline]
pub fn unit<R: Rng>(rng: &mut R) -> f64 {
    const SCALE: f64 = 1.0 / (1_u64 << 53) as f64;
    (rng.next_u64() >> 11) as f64 * SCALE
}

/// Exponential with mean 1: `−ln u` with `u` uniform in `(0, 1]`, so that it is never infinite.
#[inline]
pub fn exponential<R: Rng>(rng: &mut R) -> f64 {
    -Lane::ln(1.0 - unit(rng))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_the_address_matters() {
        let base = Address { seed: 1, experiment: 2, block: 3, lane: 0 };
        let others = [
            Address { seed: 2, ..base },
            Address { experiment: 3, ..base },
            Address { block: 4, ..base },
            Address { lane: PILOT, ..base },
        ];
        let first = base.stream().next_u64();
        assert_eq!(first, base.stream().next_u64());
        for other in others {
            assert_ne!(first, other.stream().next_u64());
        }
    }

    #[test]
    fn no_two_lanes_share_a_stream() {
        let base = Address { seed: 1, experiment: 2, block: 3, lane: 0 };
        let mut beginnings: Vec<u64> = (0..4)
            .flat_map(|block| Address { block, ..base }.streams().words().take(LANES))
            .collect();
        beginnings.push(base.pilot().next_u64());
        beginnings.sort_unstable();
        assert!(beginnings.windows(2).all(|pair| pair[0] != pair[1]));
    }

    #[test]
    fn exponential_has_mean_and_variance_one() {
        let mut rng = Address { seed: 1, experiment: 0, block: 0, lane: 0 }.stream();
        let n = 1_000_000;
        let draws: Vec<f64> = (0..n).map(|_| exponential(&mut rng)).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        let variance = draws.iter().map(|x| (x - 1.0).powi(2)).sum::<f64>() / f64::from(n);
        assert!((mean - 1.0).abs() < 5e-3, "5 standard errors: {mean}");
        assert!((variance - 1.0).abs() < 15e-3, "5 standard errors: {variance}");
    }
}

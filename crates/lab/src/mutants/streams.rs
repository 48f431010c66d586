//! Wrong streams: right estimators on random numbers that are used twice.
//!
//! ```text
//! (seed, experiment, block, lane) → stream;  no two addresses share a number;  16 lanes to a block
//! ```
//!
//! The mean stays right, and so does every single block: what is wrong is the spread of the blocks'
//! means among each other, and so every standard error.

use super::{About, MutantTarget, product};
use gate::CheckId;
use numeric::rng::{Address, LANES, Streams};

/// The experiment on which they are shown.
pub const TARGET: MutantTarget = product::LINEAR.target;

/// A known bug in what leads from addresses to random numbers.
#[derive(Debug, Clone, Copy)]
pub struct StreamMutant {
    /// The name, unique among all mutants.
    pub name: &'static str,
    /// The bug in one sentence.
    pub bug: &'static str,
    /// The check that must catch it.
    pub check: CheckId,
    /// The streams of a block; [`Address::streams`] is right.
    pub streams: fn(Address) -> Streams,
}

impl StreamMutant {
    /// The description.
    pub fn about(&self) -> About {
        About { name: self.name, bug: self.bug, target: TARGET, check: self.check }
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub const MUTANTS: &[StreamMutant] = &[
    wrong("stream-one-seed", "every block has the same streams", CheckId::Streams, |address| block(address, 0)),
    wrong("stream-pairs", "two neighbouring blocks share their streams", CheckId::Streams, |address| block(address, address.block / 2)),
    wrong("stream-recycled", "after four blocks the streams begin anew", CheckId::Streams, |address| block(address, address.block % 4)),
    wrong("stream-few-seeds", "the block is hashed to four bits: sixteen sets of streams in no order", CheckId::Streams, |address| block(address, hashed(address.block) >> 60)),
    wrong("stream-overlap", "a lane's blocks are parts of one long stream, 512 numbers apart, and use more than that", CheckId::Generator, |address| advanced(address, 512)),
    wrong("stream-creeping", "each block's stream is the one before it without its first number", CheckId::Generator, |address| advanced(address, 1)),
    wrong("stream-one-lane", "all lanes of a block have the same stream", CheckId::Generator, |address| Streams { lanes: [address.stream(); LANES], ..address.streams() }),
    wrong("stream-lanes-shift", "each lane has the stream of its neighbour in the block before", CheckId::Generator, shifted),
];

const fn wrong(
    name: &'static str,
    bug: &'static str,
    check: CheckId,
    streams: fn(Address) -> Streams,
) -> StreamMutant {
    StreamMutant { name, bug, check, streams }
}

/// Lane l of block b has the stream of block 0 and lane b + l.
fn shifted(address: Address) -> Streams {
    let lane = |lane: usize| Address { block: 0, lane: address.block + lane as u64, ..address };
    Streams { lanes: std::array::from_fn(|l| lane(l).stream()), ..address.streams() }
}

/// The streams of another block.
fn block(address: Address, block: u64) -> Streams {
    Address { block, ..address }.streams()
}

/// Block b has the first block's streams, `b · stride` numbers on.
fn advanced(address: Address, stride: u64) -> Streams {
    let mut streams = block(address, 0);
    for stream in &mut streams.lanes {
        for _ in 0..address.block * stride {
            stream.word();
        }
    }
    streams
}

/// Fibonacci hashing (D. E. Knuth, *The Art of Computer Programming* 3, section 6.4), scrambled once
/// more: multiples of the golden ratio alone would be too even.
fn hashed(block: u64) -> u64 {
    let scattered = (block + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (scattered ^ (scattered >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9)
}

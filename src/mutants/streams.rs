//! Wrong streams: right estimators on random numbers that are used twice.
//!
//! ```text
//! (seed, experiment, block, lane) → stream;  no two addresses share a number;  8 lanes to a block
//! ```
//!
//! The mean stays right, and so does every single block: what is wrong is the spread of the blocks'
//! means among each other, and so every standard error.

use super::target::{self, Target};
use crate::rng::{Address, LANES, Streams};

/// The experiment on which they are shown.
pub const TARGET: Target = target::LINEAR;

/// A known bug in what leads from addresses to random numbers.
#[derive(Debug, Clone, Copy)]
pub struct StreamMutant {
    /// The name, unique among all mutants.
    pub name: &'static str,
    /// The bug in one sentence.
    pub bug: &'static str,
    /// The check that must catch it.
    pub check: &'static str,
    /// The streams of a block; [`Address::streams`] is right.
    pub streams: fn(Address) -> Streams,
}

/// The family.
pub const MUTANTS: &[StreamMutant] = &[
    StreamMutant {
        name: "stream-one-seed",
        bug: "every block has the same streams",
        check: "streams",
        streams: |address| block(address, 0),
    },
    StreamMutant {
        name: "stream-pairs",
        bug: "two neighbouring blocks share their streams",
        check: "streams",
        streams: |address| block(address, address.block / 2),
    },
    StreamMutant {
        name: "stream-recycled",
        bug: "after four blocks the streams begin anew",
        check: "streams",
        streams: |address| block(address, address.block % 4),
    },
    StreamMutant {
        name: "stream-few-seeds",
        bug: "the block is hashed to four bits: sixteen sets of streams in no order",
        check: "streams",
        streams: |address| block(address, hashed(address.block) >> 60),
    },
    StreamMutant {
        name: "stream-overlap",
        bug: "a lane's blocks are parts of one long stream, 512 numbers apart, and use more than that",
        check: "generator",
        streams: |address| advanced(address, 512),
    },
    StreamMutant {
        name: "stream-creeping",
        bug: "each block's stream is the one before it without its first number",
        check: "generator",
        streams: |address| advanced(address, 1),
    },
    StreamMutant {
        name: "stream-one-lane",
        bug: "all lanes of a block have the same stream",
        check: "generator",
        streams: |address| Streams { lanes: [address.stream(); LANES], ..address.streams() },
    },
    StreamMutant {
        name: "stream-lanes-shift",
        bug: "each lane has the stream of its neighbour in the block before",
        check: "generator",
        streams: |address| {
            let lane =
                |lane: usize| Address { block: 0, lane: address.block + lane as u64, ..address };
            let lanes = std::array::from_fn(|l| lane(l).stream());
            Streams { lanes, ..address.streams() }
        },
    },
];

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

//! Wrong streams: right estimators on random numbers that are used twice.
//!
//! ```text
//! (seed, experiment, block, lane) → stream;  no two addresses share a number
//! ```
//!
//! The mean stays right, and so does every single block: what is wrong is the spread of the blocks'
//! means among each other, and so every standard error.

use super::target::{self, Target};
use crate::rng::{Address, Stream};

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
    /// The stream at an address; [`Address::stream`] is right.
    pub stream: fn(Address) -> Stream,
}

/// The family.
pub const MUTANTS: &[StreamMutant] = &[
    StreamMutant {
        name: "stream-one-seed",
        bug: "every block has the same stream",
        check: "streams",
        stream: |address| block(address, 0),
    },
    StreamMutant {
        name: "stream-pairs",
        bug: "two neighbouring blocks share a stream",
        check: "streams",
        stream: |address| block(address, address.block / 2),
    },
    StreamMutant {
        name: "stream-recycled",
        bug: "after four blocks the streams begin anew",
        check: "streams",
        stream: |address| block(address, address.block % 4),
    },
    StreamMutant {
        name: "stream-few-seeds",
        bug: "the block is hashed to four bits: sixteen streams in no order",
        check: "streams",
        stream: |address| block(address, hashed(address.block) >> 60),
    },
    StreamMutant {
        name: "stream-overlap",
        bug: "blocks are parts of one long stream, 4096 numbers apart, and use more than that",
        check: "generator",
        stream: |address| advanced(address, 1 << 12),
    },
    StreamMutant {
        name: "stream-creeping",
        bug: "each block's stream is the one before it without its first number",
        check: "generator",
        stream: |address| advanced(address, 1),
    },
];

/// The stream of another block.
fn block(address: Address, block: u64) -> Stream {
    Address { block, ..address }.stream()
}

/// Block b is the first block's stream, `b · stride` numbers on.
fn advanced(address: Address, stride: u64) -> Stream {
    let mut stream = block(address, 0);
    stream.advance(u128::from(address.block) * u128::from(stride));
    stream
}

/// Fibonacci hashing (D. E. Knuth, *The Art of Computer Programming* 3, section 6.4), scrambled once
/// more: multiples of the golden ratio alone would be too even.
fn hashed(block: u64) -> u64 {
    let scattered = (block + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (scattered ^ (scattered >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9)
}

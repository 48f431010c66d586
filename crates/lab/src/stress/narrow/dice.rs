//! Random words of walks.

use numeric::rng::{Address, Stream, name_hash};

/// A stream of random words.
pub struct Dice(Stream);

impl Dice {
    /// The stream of a part of a quantity.
    pub fn new(seed: u64, quantity: &str, part: u64) -> Self {
        let experiment = name_hash(&format!("stress|{quantity}"));
        Self(Address { seed, experiment, block: part, lane: 0 }.stream())
    }

    /// Returns 64 random bits.
    pub fn word(&mut self) -> u64 {
        self.0.word()
    }
}

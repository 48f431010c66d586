//! Draws behind averages: whether all averages hold the same draws, and whether draws come again across them.
//!
//! Draws within an average may depend on each other in any way, and each place of an average may have a distribution of
//! its own, such as a pixel that is black in every pass. So a distance that is shorter than an average, or a multiple of
//! its length, says nothing: equal averages betray the latter by themselves. What is left is a distance across
//! averages that independent ones have only if values come in a fixed order of their own, and averages that all
//! hold the same draws, which no independent ones do unless their draws have no chance in them.

use crate::stats::replays::{Replay, Replays, hash};
use crate::stats::sequences::Sequences;

/// Minimum number of averages that may be called alike.
const FEWEST: u64 = 3;

/// Draws behind averages of `batch` draws each.
pub(super) struct Contents {
    batch: u64,
    replays: Replays,
    sequences: Sequences,
    /// Draws and their hash in the average that is not complete yet.
    count: u64,
    hash: u64,
    first: Option<u64>,
    averages: u64,
    are_alike: bool,
    last: f64,
    is_varied: bool,
}

impl Contents {
    pub(super) fn new(batch: u64) -> Self {
        Self {
            batch,
            replays: Replays::default(),
            sequences: Sequences::default(),
            count: 0,
            hash: 0,
            first: None,
            averages: 0,
            are_alike: true,
            last: f64::NAN,
            is_varied: false,
        }
    }

    pub(super) fn absorb(&mut self, draws: &[f64]) {
        self.replays.absorb(draws);
        self.sequences.absorb(draws);
        if !self.are_alike {
            return;
        }
        for &x in draws {
            self.is_varied |= x != self.last && self.last.is_finite();
            self.last = x;
            self.hash = hash(self.hash.rotate_left(1) ^ x.to_bits());
            self.count += 1;
            if self.count == self.batch {
                self.averages += 1;
                self.are_alike &= *self.first.get_or_insert(self.hash) == self.hash;
                (self.count, self.hash) = (0, 0);
            }
        }
    }

    /// Number of averages, if all hold the same draws, and these are not all alike.
    pub(super) fn alike(&self) -> Option<u64> {
        let is_shown = self.are_alike && self.is_varied && self.averages >= FEWEST;
        is_shown.then_some(self.averages)
    }

    /// Draws that come again in other averages, at another place.
    pub(super) fn replay(&self) -> Option<Replay> {
        let found = [self.replays.found(), self.sequences.found()].into_iter().flatten();
        let across = |found: &Replay| {
            found.distance > self.batch && !found.distance.is_multiple_of(self.batch)
        };
        found.filter(across).min_by(|a, b| a.ln_p.total_cmp(&b.ln_p))
    }
}

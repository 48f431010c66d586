//! Where the draws of eight walks side by side go.
//!
//! A walk that ends begins anew at once, so that no lane waits, and every lane makes a number of draws
//! that was fixed beforehand. A lane that has made them walks on until the others have; its stream
//! stays where its last draw left it.

use fearless_simd::{Simd, u64x8};

use crate::numeric::pack::WIDTH;
use crate::rng::{LANES, Streams, Xoshiro};

/// What each lane has to do and has done.
pub struct Places {
    /// The place of each lane's next draw.
    next: [usize; WIDTH],
    /// The number of the step in which its walk began.
    began: [u32; WIDTH],
    /// The number of this step.
    now: u32,
    /// How many lanes have draws left.
    open: usize,
    count: usize,
}

/// A draw of a lane.
#[derive(Clone, Copy)]
pub struct Place {
    /// The lane.
    pub lane: usize,
    /// The draw's number in the buffer.
    pub draw: usize,
    /// How many steps the walk made before this one.
    pub steps: u32,
}

impl Places {
    /// So many draws, of which the first comes from the lane whose turn it is.
    #[must_use]
    pub fn new(count: usize, turn: usize) -> Self {
        let mut next = [0; WIDTH];
        for (lane, draw) in next.iter_mut().enumerate() {
            *draw = (lane + LANES - turn) % LANES;
        }
        let open = next.iter().filter(|&&draw| draw < count).count();
        Self { next, began: [0; WIDTH], now: 0, open, count }
    }

    /// Whether some lane has draws left.
    #[inline(always)]
    #[must_use]
    pub fn are_open(&self) -> bool {
        self.open > 0
    }

    /// The step is over.
    #[inline(always)]
    pub fn step(&mut self) {
        self.now = self.now.wrapping_add(1);
    }

    /// Hands out the places of the walks that end in this step, as bits; answers whose last ones these
    /// are.
    #[inline(always)]
    pub fn fill(&mut self, mut ended: u64, mut write: impl FnMut(Place)) -> u64 {
        let mut over = 0;
        while ended != 0 {
            let lane = (ended.trailing_zeros() & 7) as usize;
            ended &= ended - 1;
            let draw = self.next[lane];
            if draw >= self.count {
                continue; // This lane has made its draws.
            }
            write(Place { lane, draw, steps: self.now.wrapping_sub(self.began[lane]) });
            self.began[lane] = self.now.wrapping_add(1);
            self.next[lane] = draw + LANES;
            if self.next[lane] >= self.count {
                self.open -= 1;
                over |= 1 << lane;
            }
        }
        over
    }
}

/// Leaves the streams of some lanes, as bits, where they stand now.
#[inline(always)]
pub fn leave<S: Simd>(streams: &mut Streams, which: u64, now: Xoshiro<u64x8<S>>) {
    if which != 0 {
        let now = now.at_rest().apart();
        for (lane, (stream, now)) in streams.lanes.iter_mut().zip(now).enumerate() {
            if which >> lane & 1 == 1 {
                *stream = now;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_draw_has_one_place_and_lanes_take_turns() {
        for (count, turn) in [(1, 0), (5, 6), (8, 3), (21, 7)] {
            let mut places = Places::new(count, turn);
            let (mut lanes, mut over) = (vec![None; count], 0);
            while places.are_open() {
                // Lanes end in every second step.
                over |= places.fill(0b0101_0101, |place| {
                    assert_eq!(
                        (lanes[place.draw].replace(place.lane), place.steps),
                        (None, place.steps & 1)
                    );
                });
                places.step();
                over |= places.fill(0b1010_1010, |place| {
                    assert_eq!(lanes[place.draw].replace(place.lane), None);
                });
                places.step();
            }
            let expected = (0..count).map(|draw| Some((turn + draw) % LANES));
            assert!(lanes.into_iter().eq(expected), "{count} from {turn}");
            assert_eq!(over.count_ones() as usize, count.min(LANES));
        }
    }
}

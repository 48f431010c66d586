//! Where the draws of eight walks side by side go: those of one pack of streams.
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
    /// Those of a pack among so many draws, of which the first comes from the lane whose turn it is.
    #[must_use]
    pub fn new(count: usize, turn: usize, pack: usize) -> Self {
        let mut next = [0; WIDTH];
        for (lane, draw) in (pack * WIDTH..).zip(&mut next) {
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

/// Leaves the streams of some lanes of a pack, as bits, where they stand now.
#[inline(always)]
pub fn leave<S: Simd>(streams: &mut Streams, pack: usize, which: u64, now: Xoshiro<u64x8<S>>) {
    if which != 0 {
        let now = now.at_rest().apart();
        let lanes = &mut streams.lanes[pack * WIDTH..];
        for (lane, (stream, now)) in lanes.iter_mut().zip(now).enumerate() {
            if which >> lane & 1 == 1 {
                *stream = now;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::PACKS;

    #[test]
    fn every_draw_has_one_place_and_lanes_take_turns() {
        for (count, turn) in [(1, 0), (5, 14), (16, 3), (45, 7)] {
            let mut lanes = vec![None; count];
            for pack in 0..PACKS {
                let (mut places, mut over) = (Places::new(count, turn, pack), 0);
                // Lanes end in every second step.
                for ended in [0b0101_0101, 0b1010_1010].into_iter().cycle() {
                    if !places.are_open() {
                        break;
                    }
                    over |= places.fill(ended, |place| {
                        assert_eq!(
                            place.steps,
                            u32::from(place.draw >= LANES || ended == 0b1010_1010)
                        );
                        let lane = pack * WIDTH + place.lane;
                        assert_eq!(lanes[place.draw].replace(lane), None);
                    });
                    places.step();
                }
                let mine = |lane: usize| lane / WIDTH == pack;
                let open = (0..count.min(LANES)).filter(|draw| mine((turn + draw) % LANES));
                assert_eq!(over.count_ones() as usize, open.count());
            }
            let expected = (0..count).map(|draw| Some((turn + draw) % LANES));
            assert!(lanes.into_iter().eq(expected), "{count} from {turn}");
        }
    }
}

//! Numbers that walks leave at their ends, from which draws are computed eight at a time.

use super::{GROUPS, MAX_OUTCOME, MAX_SCORED, Walk};
use crate::DrawBuffer;
use numeric::Lane;
use numeric::pack::{Hardware, WIDTH};

/// No event, or no draw.
const NONE: u32 = u32::MAX;

/// Lists of numbers, side by side, that are the outcome of eight walks.
pub type Groups<'a, L> = [&'a [L]; GROUPS];

/// Size of a record: the numbers in `groups`, and one more.
pub fn count<L>(groups: Groups<L>) -> usize {
    1 + groups.iter().map(|group| group.len()).sum::<usize>()
}

/// Outcomes of draws or events, in groups of eight, number by number.
pub struct Outcomes {
    numbers: usize,
    at: Vec<f64>,
}

impl Outcomes {
    /// Memory for `numbers` numbers of each of `draws` draws; empty if there are no draws.
    pub fn new(numbers: usize, draws: usize, room: &mut Vec<f64>) -> Self {
        let mut outcomes = Self { numbers, at: Vec::new() };
        if draws > 0 {
            outcomes.at = std::mem::take(room);
            outcomes.make_room(draws);
        }
        outcomes
    }

    /// The memory, for reuse.
    pub fn into_room(self) -> Vec<f64> {
        self.at
    }

    fn make_room(&mut self, draws: usize) {
        self.at.resize(draws.next_multiple_of(WIDTH) * self.numbers, 0.0);
    }

    /// Writes a code for how a walk ended, and the numbers that it leaves in a lane.
    #[inline(always)]
    pub fn write(&mut self, draw: usize, how: f64, numbers: &[[f64; WIDTH]], lane: usize) {
        let mut place = draw / WIDTH * self.numbers * WIDTH + draw % WIDTH;
        self.at[place] = how;
        for row in numbers {
            place += WIDTH;
            self.at[place] = row[lane];
        }
    }

    #[inline(always)]
    fn read<S: Hardware>(&self, simd: S, first: usize, numbers: &mut [S::Pack]) {
        let (rows, _) = self.at[first * self.numbers..].as_chunks();
        for (lanes, row) in numbers.iter_mut().zip(rows) {
            *lanes = simd.load(row);
        }
    }

    /// Computes the values of draws; their lookups are in the buffer.
    #[inline(always)]
    pub fn score<S: Hardware>(
        &self,
        simd: S,
        walk: &impl Walk,
        draws: usize,
        buffer: &mut DrawBuffer,
    ) {
        let zero = simd.splat(0.0);
        let (mut numbers, mut values) = ([zero; MAX_OUTCOME + 1], [zero; MAX_SCORED]);
        let (numbers, values) = (&mut numbers[..self.numbers], &mut values[..walk.channels()]);
        buffer.make_room(draws.next_multiple_of(WIDTH));
        for first in (0..draws).step_by(WIDTH) {
            self.read(simd, first, numbers);
            let mut lookups = [0.0; WIDTH];
            for (lane, lookups) in lookups.iter_mut().enumerate() {
                *lookups = f64::from(buffer.lookups[first + lane]);
            }
            let lookups = simd.load(&lookups);
            let defect = walk.score(&numbers[1..], zero.below(numbers[0]), lookups, values);
            defect.store(&mut buffer.defects[first..first + WIDTH]);
            // Pictures need fewer channels.
            for (channel, row) in buffer.values.iter_mut().enumerate() {
                values[channel].store(&mut row[first..first + WIDTH]);
            }
        }
        buffer.make_room(draws);
    }
}

/// Events of walks that score at any step: the draw of an event is known when its walk has ended.
pub struct Events {
    outcomes: Outcomes,
    /// The draw of each.
    draws: Vec<u32>,
    /// The event of the same walk before each.
    before: Vec<u32>,
    /// The last event of the walk of each lane.
    last: [[u32; WIDTH]; 2],
    count: usize,
}

impl Events {
    /// Memory for `some` events with `numbers` numbers each.
    pub fn new(numbers: usize, some: usize, room: &mut Vec<f64>) -> Self {
        let (outcomes, none) = (Outcomes::new(numbers, some, room), Vec::new());
        let last = [[NONE; WIDTH]; 2];
        let mut events = Self { outcomes, draws: none.clone(), before: none, last, count: 0 };
        events.make_room(some.next_multiple_of(WIDTH));
        events
    }

    /// The memory for numbers, for reuse.
    pub fn into_room(self) -> Vec<f64> {
        self.outcomes.into_room()
    }

    fn make_room(&mut self, events: usize) {
        self.outcomes.make_room(events);
        self.draws.resize(events, NONE);
        self.before.resize(events, NONE);
    }

    /// Adds events of some lanes of a pack, as bits.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation)] // fewer than 2^32
    pub fn push(&mut self, pack: usize, mut which: u64, numbers: &[[f64; WIDTH]]) {
        if self.count + WIDTH > self.draws.len() {
            self.make_room(2 * self.draws.len() + WIDTH);
        }
        while which != 0 {
            let lane = (which.trailing_zeros() & 7) as usize;
            which &= which - 1;
            self.outcomes.write(self.count, 1.0, numbers, lane);
            self.before[self.count] = self.last[pack][lane];
            self.last[pack][lane] = self.count as u32;
            self.count += 1;
        }
    }

    /// Discards the events of some lanes of a pack, as bits: their walks end without a draw.
    #[inline(always)]
    pub fn forget(&mut self, pack: usize, which: u64) {
        for (lane, last) in self.last[pack].iter_mut().enumerate() {
            *last = if which >> lane & 1 == 1 { NONE } else { *last };
        }
    }

    /// Assigns the events of a lane of a pack to a draw: its walk has ended.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // fewer than 2^32
    pub fn belong(&mut self, pack: usize, lane: usize, draw: usize) {
        let mut event = self.last[pack][lane];
        while let Some(own) = self.draws.get_mut(event as usize) {
            *own = draw as u32;
            event = self.before[event as usize];
        }
    }

    /// Adds all scores to their draws.
    #[inline(always)]
    pub fn score<S: Hardware>(&self, simd: S, walk: &impl Walk, buffer: &mut DrawBuffer) {
        let zero = simd.splat(0.0);
        let (mut numbers, mut values) = ([zero; MAX_OUTCOME + 1], [zero; MAX_SCORED]);
        let (numbers, values) =
            (&mut numbers[..self.outcomes.numbers], &mut values[..walk.channels()]);
        for channel in &mut buffer.values {
            channel.fill(0.0);
        }
        let mut rows = [[0.0; WIDTH]; MAX_SCORED];
        for first in (0..self.count).step_by(WIDTH) {
            self.outcomes.read(simd, first, numbers);
            walk.score(&numbers[1..], zero.at_most(zero), zero, values);
            for (row, value) in rows.iter_mut().zip(&*values) {
                value.store(row);
            }
            add(&rows[..values.len()], &self.draws[first..first + WIDTH], buffer);
        }
    }
}

/// Adds the scores of eight events to their draws.
#[inline(never)]
fn add(values: &[[f64; WIDTH]], draws: &[u32], buffer: &mut DrawBuffer) {
    for (lane, &draw) in draws.iter().enumerate().filter(|(_, draw)| **draw != NONE) {
        for (row, value) in buffer.values.iter_mut().zip(values) {
            row[draw as usize] += value[lane];
        }
    }
}

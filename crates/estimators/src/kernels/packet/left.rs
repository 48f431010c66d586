//! What walks leave behind when they end, and the draws that are made of it eight at a time.
//!
//! Walks end one by one, and few in the same step: what takes exponentials and divisions to score is left until all
//! have ended.

use fearless_simd::{Simd, SimdBase, f64x8};

use super::bank::{Slot, Slots};
use crate::kernels::DrawBuffer;
use numeric::pack::WIDTH;

/// Numbers of each draw, or of each of other things: those of eight of them side by side, number by number.
pub struct Left {
    numbers: usize,
    at: Vec<f64>,
}

impl Left {
    /// Room for so many numbers of so many draws.
    pub fn new(numbers: usize, draws: usize) -> Self {
        let mut left = Self { numbers, at: Vec::new() };
        left.make_room(draws);
        left
    }

    /// Makes room for so many draws.
    pub fn make_room(&mut self, draws: usize) {
        self.at.resize(draws.next_multiple_of(WIDTH) * self.numbers, 0.0);
    }

    /// Writes what a lane leaves.
    #[inline(always)]
    pub fn write<S: Simd, const GROUPS: usize>(
        &mut self,
        draw: usize,
        groups: [&[f64x8<S>]; GROUPS],
        lane: usize,
    ) {
        let mut place = self.place(0, draw);
        for group in groups {
            for numbers in group {
                self.at[place] = numbers.as_slice()[lane];
                place += WIDTH;
            }
        }
    }

    /// Walks that ended, as bits, leave numbers; answers whose last ones these are.
    #[inline(never)]
    pub fn collect<S: Simd, const GROUPS: usize>(
        &mut self,
        groups: [&[f64x8<S>]; GROUPS],
        (ended, slots): (u64, &mut Slots),
    ) -> u64 {
        slots.fill(
            ended,
            #[inline(always)]
            |Slot { lane, draw, .. }| self.write(draw, groups, lane),
        )
    }

    /// A number of eight draws, from one of them on.
    #[inline(always)]
    pub fn row<S: Simd>(&self, simd: S, number: usize, first: usize) -> f64x8<S> {
        f64x8::from_slice(simd, &self.at[self.place(number, first)..][..WIDTH])
    }

    #[inline(always)]
    fn place(&self, number: usize, draw: usize) -> usize {
        (draw / WIDTH * self.numbers + number) * WIDTH + draw % WIDTH
    }
}

/// Walks that ended, as bits, make their draws of a number for each channel; answers whose last ones these are.
#[inline(never)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
pub fn draws<S: Simd>(
    values: &[f64x8<S>],
    lookups: &f64x8<S>,
    (ended, slots): (u64, &mut Slots),
    buffer: &mut DrawBuffer,
) -> u64 {
    slots.fill(ended, |Slot { lane, draw, .. }| {
        for (channel, values) in values.iter().enumerate() {
            buffer.values[channel][draw] = values.as_slice()[lane];
        }
        buffer.defects[draw] = 0.0;
        buffer.lookups[draw] = lookups.as_slice()[lane] as u32;
    })
}

/// Draws of several channels that are written eight at a time.
pub struct Made<'a> {
    buffer: &'a mut DrawBuffer,
    draws: usize,
}

impl<'a> Made<'a> {
    /// Room for so many draws.
    pub fn new(buffer: &'a mut DrawBuffer, draws: usize) -> Self {
        buffer.make_room(draws.next_multiple_of(WIDTH));
        Self { buffer, draws }
    }

    /// The numbers of the draws with which packs of eight begin.
    pub fn packs(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.draws).step_by(WIDTH)
    }

    /// Writes values, lookups and defects of eight draws.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    pub fn write<S: Simd>(
        &mut self,
        first: usize,
        values: &[f64x8<S>],
        [lookups, defects]: [f64x8<S>; 2],
    ) {
        for (channel, values) in values.iter().enumerate() {
            values.store_slice(&mut self.buffer.values[channel][first..first + WIDTH]);
        }
        defects.store_slice(&mut self.buffer.defects[first..first + WIDTH]);
        let mut counts = [0.0; WIDTH];
        lookups.store_slice(&mut counts);
        for (lane, &count) in counts.iter().enumerate() {
            self.buffer.lookups[first + lane] = count as u32;
        }
    }

    /// All are written.
    pub fn end(self) {
        self.buffer.make_room(self.draws);
    }
}

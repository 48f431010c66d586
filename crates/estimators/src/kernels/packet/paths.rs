//! Paths that came to the emitter: what their densities are made of, and the scores of eight of them at a time.
//!
//! A walk may score several times, and in each step few do. Which draw a path belongs to is known when its walk has ended.

use fearless_simd::{Simd, SimdBase, f64x8};

use crate::kernels::DrawBuffer;
use crate::kernels::packet::hero::Media;
use crate::kernels::packet::left::Left;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::pack::WIDTH;

/// No path, or no draw.
const NONE: u32 = u32::MAX;

/// What is noted of a path beside its weights, phase functions and null collisions in each channel: its hero, its length,
/// its collisions, the weight of `p_nee` among the densities, and what their sum is multiplied by.
pub const REST: usize = 5;

/// The last path of the walk of each lane.
pub type Last = [u32; WIDTH];

/// Walks without a path.
pub const NOTHING: Last = [NONE; WIDTH];

/// All paths of a request, in the order in which they came to the emitter.
pub struct Events {
    left: Left,
    /// The draw of each.
    draws: Vec<u32>,
    /// The path of the same walk before each.
    before: Vec<u32>,
    count: usize,
}

impl Events {
    /// Room for some paths of so many channels.
    pub fn new(channels: usize, some: usize) -> Self {
        let left = Left::new(REST + 3 * channels, 0);
        let mut events = Self { left, draws: Vec::new(), before: Vec::new(), count: 0 };
        events.make_room(some.next_multiple_of(WIDTH));
        events
    }

    fn make_room(&mut self, paths: usize) {
        self.left.make_room(paths);
        self.draws.resize(paths, NONE);
        self.before.resize(paths, NONE);
    }

    /// The walks of some lanes, as bits, came to the emitter.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation)] // fewer than 2^32
    pub fn push<S: Simd, const GROUPS: usize>(
        &mut self,
        mut which: u64,
        last: &mut Last,
        groups: [&[f64x8<S>]; GROUPS],
    ) {
        if self.count + WIDTH > self.draws.len() {
            self.make_room(2 * self.draws.len() + WIDTH);
        }
        while which != 0 {
            let lane = (which.trailing_zeros() & 7) as usize;
            which &= which - 1;
            self.left.write(self.count, groups, lane);
            self.before[self.count] = last[lane];
            last[lane] = self.count as u32;
            self.count += 1;
        }
    }

    /// The walk whose last path this is was a draw.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // fewer than 2^32
    pub fn belong(&mut self, mut path: u32, draw: usize) {
        while let Some(own) = self.draws.get_mut(path as usize) {
            *own = draw as u32;
            path = self.before[path as usize];
        }
    }

    /// Adds all scores to their draws.
    #[inline(always)]
    pub fn score<S: Simd>(&self, simd: S, media: &Media, buffer: &mut DrawBuffer) {
        let count = media.count;
        let zero = f64x8::splat(simd, 0.0);
        let mut found = [zero; MOST_CHANNELS];
        let found = &mut found[..count];
        for channel in &mut buffer.values[..count] {
            channel.fill(0.0);
        }
        for first in (0..self.count).step_by(WIDTH) {
            let row = Row { simd, left: &self.left, first };
            let (next_event, share) = (row.at(3), row.at(4));
            for (channel, found) in found.iter_mut().enumerate() {
                *found = row.at(REST + channel);
            }
            media.common(row.at(0), [row.at(1), row.at(2)], found);
            let mut density = zero;
            for (channel, found) in found.iter_mut().enumerate() {
                let common = *found;
                *found =
                    common * row.at(REST + count + channel) * row.at(REST + 2 * count + channel);
                density += *found * media.chances[channel];
                density += common * media.chances[channel] * next_event;
            }
            let scale = zero.each(1.0) / (density * share);
            let scale = Lane::select(zero.below(density), scale, zero);
            for found in found.iter_mut() {
                *found *= scale;
            }
            add(found, &self.draws[first..][..WIDTH], buffer);
        }
    }
}

/// Numbers of eight paths.
#[derive(Clone, Copy)]
struct Row<'a, S> {
    simd: S,
    left: &'a Left,
    first: usize,
}

impl<S: Simd> Row<'_, S> {
    #[inline(always)]
    fn at(self, number: usize) -> f64x8<S> {
        self.left.row(self.simd, number, self.first)
    }
}

/// Adds the scores of eight paths to their draws.
#[inline(never)]
fn add<S: Simd>(found: &[f64x8<S>], draws: &[u32], buffer: &mut DrawBuffer) {
    for (lane, &draw) in draws.iter().enumerate().filter(|(_, draw)| **draw != NONE) {
        for (channel, found) in found.iter().enumerate() {
            buffer.values[channel][draw as usize] += found.as_slice()[lane];
        }
    }
}

//! Bidirectional paths of sixteen draws side by side, by independent subpaths through a σ̂ of one value.
//!
//! Specification: draw j is, bit for bit, the draw that the page `bidirectional_rod/walk` makes from stream j mod 16.
//!
//! All lanes make the same technique at the same time. A flight goes on until the last of them has come to its next real
//! collision; those that have none left wait, and their streams with them.

mod path;
mod tracker;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use self::path::Paths;
use self::tracker::{Subpaths, Tracker};
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::leave;
use crate::setup::Setup;
use media::{Lookups, even};
use numeric::pack::{self, Task, WIDTH};
use numeric::rng::{LANES, PACKS};
use theory::bidirectional_rod::Combination;
use theory::problems::BidirectionalRod;
use theory::problems::bidirectional_rod::HIGHEST_ORDER;

/// Which techniques make paths, and how.
#[derive(Debug, Clone, Copy)]
pub struct Techniques {
    /// Which, and what they are worth beside each other.
    pub combination: Combination,
    /// Whether connections are tracked.
    pub is_tracked: bool,
}

/// The draws of techniques, on the hardware of a level; a request is handed back where the hardware is too narrow, or σ̂
/// has several values.
pub fn paths<'a>(
    level: Level,
    page: Techniques,
    setup: &Setup<BidirectionalRod>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let Some(sampling) = setup.sampling.even() else { return Some(request) };
    let task = Draws { page, setup, sampling, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Draws<'a, 'r> {
    page: Techniques,
    setup: &'a Setup<BidirectionalRod>,
    sampling: &'a even::Even,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Draws<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { page, setup, sampling, medium, request } = self;
        let Request { streams, count, buffer } = request;
        buffer.make_room(count);
        let (problem, zero) = (&*setup.problem, f64x8::splat(simd, 0.0));
        let [first, second] = streams.packs();
        let nobody = mask64x8::splat(simd, false);
        let subpath = Subpaths {
            at: [zero; HIGHEST_ORDER],
            is_forward: [nobody; HIGHEST_ORDER + 1],
            nulls: [zero; HIGHEST_ORDER + 1],
            last: zero,
            whole: nobody,
            left: nobody,
        };
        let mut tracker = Tracker {
            simd,
            page,
            setup,
            medium,
            sampling,
            numbers: [first.awake(simd), second.awake(simd)],
            lookups: [zero; PACKS],
            subpaths: [[subpath; PACKS]; 2],
            paths: [Paths::new(zero, problem.albedo); PACKS],
        };
        for base in (0..count).step_by(LANES) {
            let draws = Batch { base, turn: streams.turn };
            let lives = draws.lives(count);
            let first = mask64x8::from_bitmask(simd, lives & 0xff);
            let lives = [first, mask64x8::from_bitmask(simd, lives >> WIDTH)];
            tracker.lookups = [zero; PACKS];
            let (mut sum, mut channel) = ([zero; PACKS], 0);
            for order in problem.orders.clone() {
                for s in page.combination.techniques(order) {
                    let worth = tracker.technique([order, s], lives);
                    for pack in 0..PACKS {
                        let others = sum[pack] + worth[pack];
                        sum[pack] = if channel == 0 { worth[pack] } else { others };
                    }
                    if problem.has_shares {
                        draws.write(&worth, &mut buffer.values[channel]);
                    }
                    channel += 1;
                }
            }
            if !problem.has_shares {
                draws.write(&sum, &mut buffer.values[0]);
            } else if channel > 1 {
                draws.write(&sum, &mut buffer.values[channel]);
            }
            // Defects stand in for whole numbers, until all are written.
            let lookups = tracker.lookups;
            draws.write(&lookups, &mut buffer.defects);
        }
        for (draw, lookups) in buffer.lookups.iter_mut().enumerate() {
            *lookups = whole(buffer.defects[draw]);
        }
        buffer.defects.fill(0.0);
        for (pack, numbers) in tracker.numbers.into_iter().enumerate() {
            leave(streams, pack, u64::from(u8::MAX), numbers);
        }
        streams.turn = (streams.turn + count) % LANES;
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn whole(number: f64) -> u32 {
    number as u32
}

/// Sixteen draws in a row, each from the lane whose turn it is.
struct Batch {
    base: usize,
    turn: usize,
}

impl Batch {
    fn draw(&self, lane: usize) -> usize {
        self.base + (lane + LANES - self.turn) % LANES
    }

    /// Which lanes have one of so many draws, as bits.
    fn lives(&self, count: usize) -> u64 {
        (0..LANES).fold(0, |bits, lane| bits | u64::from(self.draw(lane) < count) << lane)
    }

    /// Writes what the lanes have into their draws.
    #[inline(never)]
    fn write<S: Simd>(&self, lanes: &[f64x8<S>; PACKS], row: &mut [f64]) {
        for lane in 0..LANES {
            if let Some(place) = row.get_mut(self.draw(lane)) {
                *place = lanes[lane / WIDTH].as_slice()[lane % WIDTH];
            }
        }
    }
}

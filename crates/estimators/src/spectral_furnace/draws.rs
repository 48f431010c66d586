//! Draws of walks into a furnace in several channels: by packs, or one by one.
//!
//! Walks of packs are scored when all have ended, eight draws at a time: few end in the same step.

use fearless_simd::{Level, Simd, SimdBase, f64x8};

use super::walk::InFurnace;
use crate::chromatic::{By, Right, Steps};
use crate::kernels::Request;
use crate::kernels::bank::Slot;
use crate::space::bank::{self, Rows, Walk};
use crate::{Draw, DrawBuffer, Setup};
use media::Batches;
use media::body::MOST_CHANNELS;
use numeric::fused::{Loop, in_own_rounding};
use numeric::geometry::Point;
use numeric::pack::{self, Task, WIDTH};
use numeric::rng::Stream;
use numeric::twin::PAIR;
use numeric::{Lane, Single, Twin};
use theory::problems::ChannelValues as Values;
use theory::problems::{Channels, SpectralFurnace};

/// Makes one draw.
#[inline(always)]
pub fn draw(
    steps: impl Steps,
    by: By,
    setup: &Setup<SpectralFurnace>,
    random: &mut Stream,
) -> Draw<Values> {
    in_own_rounding(One { walk: InFurnace::new(steps, by, setup), problem: &setup.problem, random })
}

struct One<'a, S> {
    walk: InFurnace<'a, S>,
    problem: &'a SpectralFurnace,
    random: &'a mut Stream,
}

impl<S: Steps> Loop for One<'_, S> {
    type Output = Draw<Values>;

    #[inline(always)]
    fn run<L: Single>(self) -> Draw<Values> {
        let Self { walk, problem, random } = self;
        let zero = L::of(0.0);
        let look_up = |place: Option<[L; 3]>| {
            let mut found = [zero; MOST_CHANNELS];
            if let Some([x, y, z]) = place {
                let place = Point([x.double(), y.double(), z.double()]);
                for (channel, medium) in problem.channels.iter().enumerate() {
                    found[channel] = L::of(medium.volume.points().extinction(place));
                }
            }
            found
        };
        let path = bank::one(&walk, look_up, random);
        let mut values = [zero; MOST_CHANNELS];
        let lookups = path.lookups;
        let defect = walk.score(|number| path.number(number), lookups, &mut values).double();
        let value = Values::of(problem.channels.len(), |channel| values[channel].double());
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
        Draw { value, lookups: lookups.double() as u32, defect }
    }
}

/// Makes the draws of a request by packs. Returns the request where the hardware is too narrow.
pub fn packets<'a>(
    level: Level,
    by: By,
    setup: &Setup<SpectralFurnace>,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let fields = setup.problem.channels.iter().map(|own| own.volume.batches(level, false));
    let fields: Vec<_> = fields.collect();
    let task = SideBySide { walk: InFurnace::new(Right, by, setup), fields: &fields, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct SideBySide<'a, 'r> {
    walk: InFurnace<'a, Right>,
    /// σ_t of each channel.
    fields: &'a [Batches<'a>],
    request: Request<'r>,
}

impl Task for SideBySide<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { walk, fields, request: Request { streams, count, buffer } } = self;
        let numbers = walk.count() + 1;
        let mut left = vec![[0.0; WIDTH]; count.div_ceil(WIDTH) * numbers];
        bank::run(
            simd,
            &walk,
            #[inline(always)]
            |points: &[[f64; PAIR]; 3]| {
                let none = [f64x8::splat(simd, 0.0); MOST_CHANNELS];
                let mut found = [none; 2];
                for (channel, field) in fields.iter().enumerate() {
                    let Twin(here, there) = field.pair(simd, points);
                    (found[0][channel], found[1][channel]) = (here, there);
                }
                found
            },
            Request { streams, count, buffer: &mut *buffer },
            |rows, slot, buffer| leave(rows, slot, &mut left, buffer),
        );
        pack::outlined(
            simd,
            #[inline(always)]
            move || score(simd, &walk, (&left, numbers), count, buffer),
        );
    }
}

/// Stores the numbers that the walk of a lane leaves, and its lookups.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn leave(
    rows: &Rows,
    Slot { lane, draw, .. }: Slot,
    left: &mut [[f64; WIDTH]],
    buffer: &mut DrawBuffer,
) {
    let numbers = rows.numbers.len() + 1;
    let own = &mut left[draw / WIDTH * numbers..][..numbers];
    for (own, row) in own.iter_mut().zip(&rows.numbers) {
        own[draw % WIDTH] = row[lane];
    }
    own[numbers - 1][draw % WIDTH] = rows.lookups[lane];
    buffer.lookups[draw] = rows.lookups[lane] as u32;
}

/// Computes the values of `count` draws.
#[inline(always)]
fn score<S: Simd>(
    simd: S,
    walk: &InFurnace<Right>,
    (left, numbers): (&[[f64; WIDTH]], usize),
    count: usize,
    buffer: &mut DrawBuffer,
) {
    let mut values = [f64x8::splat(simd, 0.0); MOST_CHANNELS];
    buffer.make_room(count.next_multiple_of(WIDTH));
    for first in (0..count).step_by(WIDTH) {
        let rows = &left[first / WIDTH * numbers..][..numbers];
        let defects = walk.score(
            #[inline(always)]
            |number| f64x8::from_slice(simd, &rows[number]),
            f64x8::from_slice(simd, &rows[numbers - 1]),
            &mut values,
        );
        for (channel, row) in buffer.values.iter_mut().enumerate() {
            values[channel].store(&mut row[first..]);
        }
        defects.store(&mut buffer.defects[first..]);
    }
    buffer.make_room(count);
}

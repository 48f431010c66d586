//! Walks in space side by side: event-based tracking of sixteen particles.
//!
//! Specification: draw j is, bit for bit, the draw that [`walk`](mod@super::walk) makes from stream j mod 16.
//!
//! ```text
//! fly       each particle flies −ln u through σ̂
//! look up   one call answers σ_t at all sixteen places
//! collide   the rule says what becomes of each; who is scattered turns, who has ended begins anew
//! ```
//!
//! A step has no branches: what happens to a particle is a mask, and streams that a step asks for no number
//! stay where they are. What a walk is worth are sums over its collisions, see [`Tally`].
//!
//! Source: F. B. Brown, W. R. Martin, *Monte Carlo methods for radiation transport analysis on vector
//! computers*, Progress in Nuclear Energy 14 (1984).

use std::sync::Arc;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8};

use super::flights::Ground;
use super::pack::Pack;
use super::particle::{Particle, Splitting};
use super::shadow::ShadowRays;
use super::tally::Tally;
use crate::DrawBuffer;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Slot, Slots};
use media::{Batches, Majorants};
use numeric::Twin;
use numeric::pack::{self, Task, WIDTH};
use numeric::rng::LANES;
use numeric::twin::PAIR;
use theory::problems::{Albedo, Scene};

/// With more cells of σ̂ than this a walk spends its time on their planes, which packets cross no faster.
const MOST_CELLS: usize = 1000;

/// The draws of a particle, on the hardware of a level; a request is handed back where that is too narrow,
/// where the particle splits, where there is no σ̂ or one of many cells, and where draws have other channels.
pub fn walks<'a, const SUMS: usize, T: Tally<SUMS>>(
    level: Level,
    tally: &T,
    particle: &Particle,
    (scene, majorants): (&Scene, Option<&Arc<Majorants>>),
    request: Request<'a>,
) -> Option<Request<'a>> {
    let Some(majorants) = majorants else { return Some(request) };
    let is_fit = particle.splitting == Splitting::None
        && majorants.cells().3.len() <= MOST_CELLS
        && request.buffer.values.len() == tally.channels().len();
    if !is_fit {
        return Some(request);
    }
    let albedo = match &scene.albedo {
        Albedo::Even(_) => None,
        Albedo::Field(field, _) => Some(field.batches(level, true)),
    };
    let world = World {
        tally,
        particle,
        scene,
        ground: Ground::new(majorants, tally.core()),
        shadow_rays: tally.shadow_rays(),
        extinction: scene.volume.batches(level, false),
        albedo,
    };
    let task = Walks { world, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

/// What all walks share.
pub struct World<'a, T> {
    /// What they are worth.
    pub tally: &'a T,
    /// What happens at a collision.
    pub particle: &'a Particle,
    /// The medium.
    pub scene: &'a Scene,
    /// σ̂.
    pub ground: Ground<'a>,
    /// How shadow rays are cast, if they are.
    pub shadow_rays: Option<ShadowRays<'a>>,
    /// σ_t.
    pub extinction: Batches<'a>,
    /// a, where it varies.
    albedo: Option<Batches<'a>>,
}

struct Walks<'a, 'r, const SUMS: usize, T> {
    world: World<'a, T>,
    request: Request<'r>,
}

impl<const SUMS: usize, T: Tally<SUMS>> Task for Walks<'_, '_, SUMS, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, request } = self;
        let Request { streams, count, buffer } = request;
        buffer.make_room(count);
        let turn = streams.turn;
        let [first, second] = streams.packs();
        let (mut slots, mut others) = (Slots::new(count, turn, 0), Slots::new(count, turn, 1));
        // Two names, not an array: what an index reaches lies in memory, and there AVX2 chooses by stores that cost
        // more than all else.
        let mut first = Pack::begin(simd, &world, first.awake(simd));
        let mut second = Pack::begin(simd, &world, second.awake(simd));
        while slots.are_open() || others.are_open() {
            let mut points = [[0.0; PAIR]; 3];
            let flown = first.fly(&world, 0, &mut points);
            let other_flown = second.fly(&world, 1, &mut points);
            let Twin(here, there) = world.extinction.pair(simd, &points);
            let Twin(a, b) = match (&world.albedo, &world.scene.albedo) {
                (Some(field), _) => field.pair(simd, &points),
                (None, albedo) => Twin::splat(simd, albedo.even().unwrap_or_default()),
            };
            first.collide(simd, &world, &flown, (here, a));
            if first.ended.any_true() {
                let over = first.finish(&world, &mut slots, buffer);
                bank::leave(streams, 0, over, first.numbers);
                first.begin_anew(simd, &world);
            }
            first.redirect(&world);
            second.collide(simd, &world, &other_flown, (there, b));
            if second.ended.any_true() {
                let over = second.finish(&world, &mut others, buffer);
                bank::leave(streams, 1, over, second.numbers);
                second.begin_anew(simd, &world);
            }
            second.redirect(&world);
        }
        streams.turn = (turn + count) % LANES;
    }
}

/// Writes the sums of walks that have ended into their draws; answers whose last ones these are.
#[inline(always)]
pub fn collect<S: Simd, const SUMS: usize>(
    sums: &[f64x8<S>; SUMS],
    lookups: &f64x8<S>,
    channels: &[usize],
    ends: (u64, &mut Slots),
    buffer: &mut DrawBuffer,
) -> u64 {
    let (mut rows, mut counts) = ([[0.0; WIDTH]; SUMS], [0.0; WIDTH]);
    for (sum, row) in rows.iter_mut().enumerate() {
        sums[sum].store_slice(row);
    }
    lookups.store_slice(&mut counts);
    write(&rows, &counts, channels, ends, buffer)
}

#[inline(never)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn write(
    rows: &[[f64; WIDTH]],
    lookups: &[f64; WIDTH],
    channels: &[usize],
    (ended, slots): (u64, &mut Slots),
    buffer: &mut DrawBuffer,
) -> u64 {
    slots.fill(ended, |Slot { lane, draw, .. }| {
        for (channel, &sum) in channels.iter().enumerate() {
            buffer.values[channel][draw] = rows[sum][lane];
        }
        buffer.defects[draw] = 0.0;
        buffer.lookups[draw] = lookups[lane] as u32;
    })
}

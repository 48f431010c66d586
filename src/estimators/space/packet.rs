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
use crate::estimators::DrawBuffer;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Slot, Slots};
use crate::media::{Batches, Majorants};
use crate::numeric::Twin;
use crate::numeric::pack::{self, Task};
use crate::numeric::twin::PAIR;
use crate::problems::{Albedo, Scene};
use crate::rng::{LANES, PACKS};

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
    extinction: Batches<'a>,
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
        let lanes = streams.packs();
        let mut packs: [Pack<S, SUMS>; PACKS] = std::array::from_fn(
            #[inline(always)]
            |pack| {
                let slots = Slots::new(count, streams.turn, pack);
                Pack::begin(simd, &world, lanes[pack].awake(simd), slots)
            },
        );
        while packs.iter().any(|pack| pack.slots.are_open()) {
            let mut points = [[0.0; PAIR]; 3];
            let [first, second] = &mut packs;
            let flown = [first.fly(&world, 0, &mut points), second.fly(&world, 1, &mut points)];
            let Twin(here, there) = world.extinction.pair(simd, &points);
            let Twin(a, b) = match (&world.albedo, &world.scene.albedo) {
                (Some(field), _) => field.pair(simd, &points),
                (None, albedo) => Twin::splat(simd, albedo.even().unwrap_or_default()),
            };
            let found = [(here, a), (there, b)];
            for (number, pack) in packs.iter_mut().enumerate() {
                pack.collide(simd, &world, &flown[number], found[number]);
                let ended = pack.ended.to_bitmask();
                if ended != 0 {
                    let over = pack.finish(&world, ended, buffer);
                    bank::leave(streams, number, over, pack.numbers);
                    pack.begin_anew(simd, &world);
                }
                pack.slots.step();
                pack.redirect(&world);
            }
        }
        streams.turn = (streams.turn + count) % LANES;
    }
}

/// Writes the sums of walks that have ended into their draws.
#[inline(never)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
pub fn collect<S: Simd>(
    sums: &[f64x8<S>],
    lookups: &f64x8<S>,
    channels: &[usize],
    (ended, slots): (u64, &mut Slots),
    buffer: &mut DrawBuffer,
) -> u64 {
    slots.fill(ended, |Slot { lane, draw, .. }| {
        for (channel, &sum) in channels.iter().enumerate() {
            buffer.values[channel][draw] = sums[sum].as_slice()[lane];
        }
        buffer.defects[draw] = 0.0;
        buffer.lookups[draw] = lookups.as_slice()[lane] as u32;
    })
}

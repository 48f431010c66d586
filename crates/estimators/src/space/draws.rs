//! Draws of walks in space: by packs, or one by one.

use std::marker::PhantomData;

use fearless_simd::{Level, Simd};

use super::bank::{self, Rows};
use super::particle::{Particle, Splitting};
use super::splitting;
use super::tally::Tally;
use super::walk::{InSpace, Steps};
use crate::kernels::Request;
use crate::kernels::bank::Slot;
use crate::{Draw, DrawBuffer};
use media::{Batches, Majorants};
use numeric::fused::{Loop, in_own_rounding};
use numeric::geometry::Point;
use numeric::pack::{self, Task};
use numeric::rng::{Random, Stream};
use numeric::twin::PAIR;
use numeric::{Single, Twin};
use theory::problems::{Albedo, Channels, Scene};

/// Maximum number of cells of σ̂ for packs: with more, a walk spends its time on their planes, which packs cross no
/// faster.
const MAX_CELLS: usize = 100_000;

/// Makes one draw of a particle by its steps; it follows the particles that split off if it `SPLITS`.
#[inline(never)]
pub fn draw<V: Channels, T: Tally, const SPLITS: bool>(
    tally: &T,
    (steps, splitting): (impl Steps, Splitting),
    world: (&Scene, &Majorants),
    random: &mut Stream,
) -> Draw<V> {
    let walk = InSpace::new(tally, steps, world, None);
    in_own_rounding(One::<V, T, _, SPLITS> {
        walk,
        tally,
        splitting,
        scene: world.0,
        random,
        values: PhantomData,
    })
}

struct One<'a, V, T, S, const SPLITS: bool> {
    walk: InSpace<'a, T, S>,
    tally: &'a T,
    splitting: Splitting,
    scene: &'a Scene,
    random: &'a mut Stream,
    values: PhantomData<V>,
}

impl<V: Channels, T: Tally, S: Steps, const SPLITS: bool> Loop for One<'_, V, T, S, SPLITS> {
    type Output = Draw<V>;

    #[inline(always)]
    fn run<L: Single>(self) -> Draw<V> {
        let Self { walk, tally, splitting, scene, random, .. } = self;
        let look_up = |place: Option<[L; 3]>| look_up(scene, place);
        follow::<L, V, T, SPLITS>(&walk, (tally, splitting), look_up, random)
    }
}

/// Makes one draw in any lane of one number, given σ_t and the albedo at a place, if they are needed.
#[inline(always)]
pub fn follow<L: Single, V: Channels, T: Tally, const SPLITS: bool>(
    walk: &InSpace<T, impl Steps>,
    (tally, splitting): (&T, Splitting),
    look_up: impl Fn(Option<[L; 3]>) -> [L; 2],
    random: &mut impl Random<L>,
) -> Draw<V> {
    let state = if SPLITS {
        splitting::follow(walk, splitting, look_up, random)
    } else {
        bank::one(walk, look_up, random)
    };
    let (sums, channels) = (T::sums(&state.found), tally.channels());
    let value = |channel: usize| sums[channels[channel]].double();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    Draw::free(V::of(channels.len(), value), state.lookups.double() as u32)
}

/// σ_t and the albedo at a place, if they are needed.
#[inline(always)]
fn look_up<L: Single>(scene: &Scene, place: Option<[L; 3]>) -> [L; 2] {
    let Some([x, y, z]) = place else { return [L::of(0.0); 2] };
    let place = Point([x.double(), y.double(), z.double()]);
    let extinction = scene.volume.points().extinction(place);
    [L::of(extinction), L::of(scene.albedo.at(place))]
}

/// Makes the draws of a request by packs. Returns the request where the hardware is too narrow, where the particle
/// splits, where σ̂ has many cells, and where draws have other channels.
pub fn packets<'a, T: Tally>(
    level: Level,
    tally: &T,
    particle: &Particle,
    (scene, majorants): (&Scene, &Majorants),
    request: Request<'a>,
) -> Option<Request<'a>> {
    let is_fit = particle.splitting == Splitting::None
        && majorants.cells().3.len() <= MAX_CELLS
        && request.buffer.values.len() == tally.channels().len();
    if !is_fit {
        return Some(request);
    }
    let albedo = match &scene.albedo {
        Albedo::Even(_) => None,
        Albedo::Field(field, _) => Some(field.batches(level, true)),
    };
    let extinction = scene.volume.batches(level, false);
    let walk = InSpace::new(tally, *particle, (scene, majorants), Some(&extinction));
    let even = scene.albedo.even().unwrap_or_default();
    let (albedo, channels) = ((albedo.as_ref(), even), tally.channels());
    let task = SideBySide { walk, extinction: &extinction, albedo, channels, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct SideBySide<'a, 'r, T> {
    walk: InSpace<'a, T, Particle>,
    /// σ_t.
    extinction: &'a Batches<'a>,
    /// a: its field where it varies, else its value.
    albedo: (Option<&'a Batches<'a>>, f64),
    channels: &'a [usize],
    request: Request<'r>,
}

impl<T: Tally> Task for SideBySide<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { walk, extinction, albedo, channels, request } = self;
        bank::run(
            simd,
            &walk,
            #[inline(always)]
            |points: &[[f64; PAIR]; 3]| {
                let Twin(here, there) = extinction.pair(simd, points);
                let Twin(a, b) = match albedo {
                    (Some(field), _) => field.pair(simd, points),
                    (None, value) => Twin::splat(simd, value),
                };
                [[here, a], [there, b]]
            },
            request,
            |rows, slot, buffer| write(rows, channels, slot, buffer),
        );
    }
}

/// Writes the draw of a lane.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
fn write(rows: &Rows, channels: &[usize], Slot { lane, draw, .. }: Slot, buffer: &mut DrawBuffer) {
    for (channel, &number) in channels.iter().enumerate() {
        buffer.values[channel][draw] = rows.numbers[number][lane];
    }
    buffer.defects[draw] = 0.0;
    buffer.lookups[draw] = rows.lookups[lane] as u32;
}

//! Walks of heroes through a furnace side by side: the packet kernel of [`super::walk`].
//!
//! Specification: draw j is, bit for bit, the draw that the page makes from stream j mod 16.
//!
//! ```text
//! fly       each walk flies −ln u/σ̂ of its hero, or leaves
//! look up   one call a channel answers σ_t at all sixteen places
//! collide   the hero's chances decide; who is scattered turns by the hero's phase function
//! score     when all have ended, eight draws at a time
//! ```
//!
//! Loops over channels count: a kernel does not inline iterators of two slices, and would lose its registers to the call.

use fearless_simd::{ExtractToken, Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use crate::Setup;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Numbers, Slots};
use crate::kernels::packet::colours::{Densities, Events, Scatterers, alone, balance};
use crate::kernels::packet::hero::{Law, Media, number_of_hero};
use crate::kernels::packet::kept::Keep;
use crate::kernels::packet::left::{Left, Made};
use crate::setup::walker::Walker;
use crate::space::exit::{Points, ends, ends_in_place};
use media::Batches;
use media::body::MOST_CHANNELS;
use numeric::geometry::{Bounds, frame};
use numeric::pack::{self, Task, WIDTH};
use numeric::rng::LANES;
use numeric::twin::PAIR;
use numeric::{Lane, Twin};
use theory::problems::SpectralFurnace;

/// What a walk leaves beside its weights: its hero, its length, its lookups.
const REST: usize = 3;

/// So near to the boundary of a ball, in radii, doubles may not tell on which side a grazing flight ends.
const DOUBTFUL: f64 = 1e-6;

/// The draws of a page on the hardware of a level, which score all channels or the hero's alone; a request is handed back
/// where the hardware is too narrow.
pub fn walks<'a, const ALL: bool>(
    level: Level,
    walker: &Walker,
    setup: &Setup<SpectralFurnace>,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let world = World::<ALL>::new(level, walker, setup);
    pack::on_wide(level, Walks { world: &world, request }).err().map(|task| task.request)
}

/// What all walks share.
struct World<'a, const ALL: bool> {
    problem: &'a SpectralFurnace,
    walker: &'a Walker,
    /// The law of the hero, if one is chosen.
    law: Option<Law>,
    media: Media,
    scatterers: Scatterers,
    extinctions: Vec<Batches<'a>>,
}

impl<'a, const ALL: bool> World<'a, ALL> {
    fn new(level: Level, walker: &'a Walker, setup: &'a Setup<SpectralFurnace>) -> Self {
        let (problem, media) =
            (&*setup.problem, Media::new(setup, &walker.probabilities(setup.channels.len())));
        let channels = problem.channels.iter();
        Self {
            problem,
            walker,
            law: walker.heroes().map(|heroes| Law::new(heroes, media.count)),
            media,
            scatterers: Scatterers::new(channels.clone().map(|own| (own.albedo, own.phase))),
            extinctions: channels.map(|channel| channel.volume.batches(level, false)).collect(),
        }
    }

    /// How many numbers a walk leaves.
    fn left(&self) -> usize {
        if ALL { self.media.count + REST } else { REST }
    }
}

struct Walks<'a, 'r, const ALL: bool> {
    world: &'a World<'a, ALL>,
    request: Request<'r>,
}

impl<const ALL: bool> Task for Walks<'_, '_, ALL> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, request } = self;
        let Request { streams, count, buffer } = request;
        let mut left = Left::new(world.left(), count);
        let (turn, [first, second]) = (streams.turn, streams.packs());
        // Two names: what an index reaches lies in memory.
        let mut first = Pack::begin(simd, world, first.awake(simd), Slots::new(count, turn, 0));
        let mut second = Pack::begin(simd, world, second.awake(simd), Slots::new(count, turn, 1));
        let mut found = [[f64x8::splat(simd, 0.0); MOST_CHANNELS]; 2];
        let mut points = [[0.0; PAIR]; 3];
        while first.slots.are_open() || second.slots.are_open() {
            first.fly(&world.problem.bounds, &mut points, 0);
            second.fly(&world.problem.bounds, &mut points, 1);
            for (channel, extinction) in world.extinctions.iter().enumerate() {
                let Twin(here, there) = extinction.pair(simd, &points);
                (found[0][channel], found[1][channel]) = (here, there);
            }
            let ended = first.collide(world, &found[0]);
            if ended.any_true() {
                let over = first.leave(world, ended, &mut left);
                bank::leave(streams, 0, over, first.numbers);
                first.begin_anew(world, ended);
            }
            let ended = second.collide(world, &found[1]);
            if ended.any_true() {
                let over = second.leave(world, ended, &mut left);
                bank::leave(streams, 1, over, second.numbers);
                second.begin_anew(world, ended);
            }
        }
        streams.turn = (streams.turn + count) % LANES;
        score(simd, world, &left, Made::new(buffer, count));
    }
}

/// Eight walks.
struct Pack<S: Simd> {
    numbers: Numbers<S>,
    slots: Slots,
    place: Points<S>,
    direction: Points<S>,
    /// Which met a collision in this step.
    inside: mask64x8<S>,
    /// The number of each hero, its σ̂ and its albedo.
    hero: f64x8<S>,
    majorant: f64x8<S>,
    albedo: f64x8<S>,
    /// As in a [`Path`](crate::kernels::hero::Path).
    length: f64x8<S>,
    collisions: f64x8<S>,
    densities: Densities<S>,
    keep: Keep<S>,
}

impl<S: Simd> Pack<S> {
    #[inline(always)]
    fn begin<const ALL: bool>(
        simd: S,
        world: &World<ALL>,
        numbers: Numbers<S>,
        slots: Slots,
    ) -> Self {
        let (zero, all) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, true));
        let mut pack = Self {
            numbers,
            slots,
            place: [zero; 3],
            direction: [zero; 3],
            inside: all,
            hero: zero,
            majorant: zero,
            albedo: zero,
            length: zero,
            collisions: zero,
            densities: Densities::new(simd),
            keep: Keep::new(simd),
        };
        pack::outlined_if_narrow(
            simd,
            #[inline(always)]
            || pack.begin_anew(world, all),
        );
        pack
    }

    /// Those that have ended begin the next walk.
    #[inline(always)]
    fn begin_anew<const ALL: bool>(&mut self, world: &World<ALL>, which: mask64x8<S>) {
        let (World { problem, law, media, scatterers, .. }, keep) = (world, self.keep);
        let zero = self.length.each(0.0);
        let hero = match law {
            Some(law) => law.choose(self.numbers.uniform_where(which)),
            None => zero,
        };
        let majorant = number_of_hero(hero, &media.majorants[..media.count]);
        let albedo = number_of_hero(hero, &scatterers.albedos[..media.count]);
        keep.put(&mut self.hero, which, hero);
        keep.put(&mut self.majorant, which, majorant);
        keep.put(&mut self.albedo, which, albedo);
        for axis in 0..3 {
            let (from, to) = (problem.entry.0[axis], problem.direction.0[axis]);
            keep.put(&mut self.place[axis], which, zero.each(from));
            keep.put(&mut self.direction[axis], which, zero.each(to));
        }
        keep.put(&mut self.length, which, zero);
        keep.put(&mut self.collisions, which, zero);
        if ALL {
            self.densities.begin(media.count, which);
        }
    }

    /// To the next tentative collision or out of the volume; writes where σ_t is asked for.
    #[inline(always)]
    fn fly(&mut self, bounds: &Bounds, points: &mut [[f64; PAIR]; 3], number: usize) {
        let flight = -self.numbers.ln_uniform() / self.majorant;
        let end = end_beyond(bounds, [self.place, self.direction], flight);
        self.inside = !end.at_most(flight);
        let piece = Lane::select(self.inside, flight, end.or_more(end.each(0.0)));
        self.length += piece;
        for (axis, row) in points.iter_mut().enumerate() {
            self.place[axis] += self.direction[axis] * piece;
            self.place[axis].store_slice(&mut row[number * WIDTH..][..WIDTH]);
        }
    }

    /// What becomes of each, given σ_t of all channels; answers whose walks end.
    #[inline(always)]
    fn collide<const ALL: bool>(
        &mut self,
        world: &World<ALL>,
        found: &[f64x8<S>; MOST_CHANNELS],
    ) -> mask64x8<S> {
        let (inside, one) = (self.inside, self.length.each(1.0));
        let collisions = self.collisions + 1.0;
        self.keep.put(&mut self.collisions, inside, collisions);
        let own = self.densities.look(&world.media, self.hero, found);
        let by = (&world.scatterers, world.walker);
        let chances = self.densities.chances(by, [own, self.albedo]);
        let [passes, scatters, _] = chances;
        let number = self.numbers.uniform_where(inside);
        let is_scattered = inside & number.below(scatters);
        let is_null = inside & !is_scattered & number.below(scatters + passes);
        let mut cosine = one;
        if is_scattered.any_true() {
            cosine = self.scatter(world, is_scattered);
        }
        if ALL {
            let events = Events { scattered: is_scattered, null: is_null, collided: inside };
            self.densities.weigh(by, self.hero, (events, chances), cosine);
        }
        !(is_scattered | is_null)
    }

    /// Some turn; answers by which cosine.
    #[inline(always)]
    fn scatter<const ALL: bool>(&mut self, world: &World<ALL>, which: mask64x8<S>) -> f64x8<S> {
        let (scatterers, hero, direction) = (&world.scatterers, self.hero, self.direction);
        let number = self.numbers.uniform_where(which);
        let turns = self.numbers.uniform_where(which);
        let (cosine, turned) = pack::outlined_if_narrow(
            turns.token(),
            #[inline(always)]
            move || {
                let cosine = scatterers.cosine(hero, number);
                (cosine, frame::turned_lanes(direction, cosine, turns))
            },
        );
        for (axis, to) in self.direction.iter_mut().enumerate() {
            self.keep.put(to, which, turned[axis]);
        }
        cosine
    }

    /// Walks that have ended leave what draws are made of; answers whose last ones these are.
    #[inline(always)]
    fn leave<const ALL: bool>(
        &mut self,
        world: &World<ALL>,
        ended: mask64x8<S>,
        left: &mut Left,
    ) -> u64 {
        let rest = [self.hero, self.length, self.collisions];
        let weights = if ALL { &self.densities.weights[..world.media.count] } else { &[] };
        let ends = (ended.to_bitmask(), &mut self.slots);
        left.collect([&rest, weights], ends)
    }
}

/// How far it is to the boundary, where a flight ends beyond it or may do so.
///
/// Where a ray grazes a ball the way is worked out in many digits: only where it is asked for.
#[inline(always)]
fn end_beyond<S: Simd>(
    bounds: &Bounds,
    [place, direction]: [Points<S>; 2],
    flight: f64x8<S>,
) -> f64x8<S> {
    let all = flight.at_most(flight);
    let rays = [place, direction];
    let Bounds::Sphere { radius, .. } = bounds else {
        return ends_in_place(bounds, rays, all)[1];
    };
    let near = ends_in_place(bounds, rays, !all)[1];
    let is_doubtful = !flight.below(near - radius * DOUBTFUL);
    if !is_doubtful.any_true() {
        return near;
    }
    ends(bounds, rays, is_doubtful)[1]
}

/// Makes draws of what walks have left.
#[inline(always)]
fn score<S: Simd, const ALL: bool>(simd: S, world: &World<ALL>, left: &Left, mut made: Made) {
    let (media, zero) = (&world.media, f64x8::splat(simd, 0.0));
    let mut found = [zero; MOST_CHANNELS];
    let found = &mut found[..media.count];
    for first in made.packs() {
        let (hero, length) = (left.row(simd, 0, first), left.row(simd, 1, first));
        let lookups = left.row(simd, 2, first);
        let mut defects = zero;
        if ALL {
            for (channel, found) in found.iter_mut().enumerate() {
                *found = left.row(simd, REST + channel, first);
            }
            media.common(hero, [length, lookups], found);
            if matches!(world.walker, Walker::Mis(_)) {
                defects = balance(media, found);
            }
        } else {
            alone(media, hero, found);
        }
        made.write(first, found, [lookups, defects]);
    }
    made.end();
}

//! Walks in space side by side: event-based tracking of sixteen particles.
//!
//! Specification: draw j is, bit for bit, the draw that [`super::walk`] makes from stream j mod 16.
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

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::exit::Points;
use super::flights::{Flights, Flown, Ground};
use super::particle::{Particle, Splitting};
use crate::estimators::DrawBuffer;
use crate::estimators::packet::Request;
pub use crate::estimators::packet::bank::Numbers;
use crate::estimators::packet::bank::{self, Slot, Slots};
use crate::geometry::{Point, frame};
use crate::media::{Batches, Majorants};
use crate::numeric::pack::{self, Task, WIDTH};
use crate::numeric::twin::PAIR;
use crate::numeric::{Lane, Twin};
use crate::problems::{Albedo, Scene};
use crate::rng::{LANES, PACKS};

/// Eight tentative collisions.
pub struct Collisions<S: Simd> {
    /// Which of them there are.
    pub inside: mask64x8<S>,
    /// Where.
    pub place: Points<S>,
    /// The weights before them.
    pub weight: f64x8<S>,
    /// `r = σ_t/σ̂`.
    pub ratio: f64x8<S>,
    /// a.
    pub albedo: f64x8<S>,
}

/// Eight particles that may have left.
pub struct Departures<S: Simd> {
    /// Which of them have.
    pub left: mask64x8<S>,
    /// Where.
    pub place: Points<S>,
    /// In which direction.
    pub direction: Points<S>,
    /// With which weight.
    pub weight: f64x8<S>,
}

/// How walks of a problem begin, and what they are worth: so many sums, which begin at 0.
pub trait Tally<const SUMS: usize> {
    /// Where particles set out, and in which directions; those that a mask names may take numbers for it.
    /// Their weight is 1.
    fn begin<S: Simd>(
        &self,
        simd: S,
        numbers: &mut Numbers<S>,
        which: mask64x8<S>,
    ) -> [Points<S>; 2];

    /// Particles flew lengths, with weights.
    #[inline(always)]
    fn flown<S: Simd>(&self, sums: &mut [f64x8<S>; SUMS], length: f64x8<S>, weight: f64x8<S>) {
        let _ = (sums, length, weight);
    }

    /// They met tentative collisions.
    #[inline(always)]
    fn collided<S: Simd>(&self, sums: &mut [f64x8<S>; SUMS], at: &Collisions<S>) {
        let _ = (sums, at);
    }

    /// They left.
    #[inline(always)]
    fn escaped<S: Simd>(&self, sums: &mut [f64x8<S>; SUMS], at: &Departures<S>) {
        let _ = (sums, at);
    }

    /// A black ball that stops all that meets it.
    fn core(&self) -> Option<(Point, f64)> {
        None
    }

    /// Which sum each channel of a draw is.
    fn channels(&self) -> &[usize];
}

/// Adds to a sum where a mask says so.
#[inline(always)]
pub fn add_where<S: Simd>(sum: &mut f64x8<S>, mask: mask64x8<S>, term: f64x8<S>) {
    *sum = Lane::select(mask, *sum + term, *sum);
}

/// The draws of a particle, on the hardware of a level; a request is handed back where that is too narrow,
/// where the particle splits, and where draws have other channels.
#[must_use]
pub fn walks<'a, const SUMS: usize, T: Tally<SUMS>>(
    level: Level,
    tally: &T,
    particle: &Particle,
    (scene, majorants): (&Scene, &Majorants),
    request: Request<'a>,
) -> Option<Request<'a>> {
    let is_fit = particle.splitting == Splitting::None
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
        extinction: scene.volume.batches(level, false),
        albedo,
    };
    let task = Walks { world, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

/// What all walks share.
struct World<'a, T> {
    tally: &'a T,
    particle: &'a Particle,
    scene: &'a Scene,
    ground: Ground<'a>,
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
                let (ended, inside) = (pack.ended.to_bitmask(), flown[number].inside.to_bitmask());
                if ended != 0 {
                    let over = pack.finish(&world, (ended, inside), buffer);
                    bank::leave(streams, number, over, pack.numbers);
                    pack.begin_anew(simd, &world);
                }
                pack.slots.step();
                if pack.turns.to_bitmask() != 0 {
                    pack.flights.enter(&world.ground, pack.turns);
                }
            }
        }
        streams.turn = (streams.turn + count) % LANES;
    }
}

/// Eight walks.
struct Pack<S: Simd, const SUMS: usize> {
    numbers: Numbers<S>,
    flights: Flights<S>,
    weight: f64x8<S>,
    sums: [f64x8<S>; SUMS],
    /// Who has ended in this step.
    ended: mask64x8<S>,
    /// Who goes on from another place in another direction.
    turns: mask64x8<S>,
    slots: Slots,
}

impl<S: Simd, const SUMS: usize> Pack<S, SUMS> {
    #[inline(always)]
    fn begin<T: Tally<SUMS>>(simd: S, world: &World<T>, numbers: Numbers<S>, slots: Slots) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let all = one.at_most(one);
        let mut pack = Self {
            numbers,
            flights: Flights::new(simd),
            weight: one,
            sums: [one.each(0.0); SUMS],
            ended: all,
            turns: all,
            slots,
        };
        pack.begin_anew(simd, world);
        pack.flights.enter(&world.ground, all);
        pack
    }

    /// Those that have ended begin the next walk.
    #[inline(always)]
    fn begin_anew<T: Tally<SUMS>>(&mut self, simd: S, world: &World<T>) {
        let ended = self.ended;
        let [origin, direction] = world.tally.begin(simd, &mut self.numbers, ended);
        for axis in 0..3 {
            let (from, to) = (&mut self.flights.origin[axis], &mut self.flights.direction[axis]);
            *from = Lane::select(ended, origin[axis], *from);
            *to = Lane::select(ended, direction[axis], *to);
        }
        self.weight = Lane::select(ended, self.weight.each(1.0), self.weight);
        for sum in &mut self.sums {
            *sum = Lane::select(ended, sum.each(0.0), *sum);
        }
        self.turns |= ended;
    }

    /// To the next tentative collision or out of the body; says where σ_t is asked for.
    #[inline(always)]
    fn fly<T: Tally<SUMS>>(
        &mut self,
        world: &World<T>,
        number: usize,
        points: &mut [[f64; PAIR]; 3],
    ) -> Flown<S> {
        let depth = -self.numbers.ln_uniform();
        let flown = self.flights.fly(&world.ground, depth);
        world.tally.flown(&mut self.sums, flown.length, self.weight);
        for (row, coordinate) in points.iter_mut().zip(flown.place) {
            coordinate.store_slice(&mut row[number * WIDTH..][..WIDTH]);
        }
        flown
    }

    /// What becomes of each, given σ_t and the albedo where it has come to.
    #[inline(always)]
    fn collide<T: Tally<SUMS>>(
        &mut self,
        simd: S,
        world: &World<T>,
        flown: &Flown<S>,
        (extinction, albedo): (f64x8<S>, f64x8<S>),
    ) {
        let Flown { inside, sampling, place, .. } = *flown;
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        let (weight, ratio) = (self.weight, extinction / sampling);
        let at = Collisions { inside, place, weight, ratio, albedo };
        world.tally.collided(&mut self.sums, &at);
        let direction = self.flights.direction;
        let at = Departures { left: !inside, place, direction, weight };
        world.tally.escaped(&mut self.sums, &at);
        let odds = world.particle.rule.odds(ratio, albedo);
        // A number is taken where chance is left, as `Steps::decide` does.
        let surely_on = odds.scatter.at_most(zero) & one.at_most(odds.transmit);
        let surely_scattered = !surely_on & one.at_most(odds.scatter);
        let by_chance = inside & !surely_on & !surely_scattered;
        let number = self.numbers.uniform_where(by_chance);
        let is_scattered = by_chance & number.below(odds.scatter);
        let is_passed = by_chance & !is_scattered & number.below(odds.scatter + odds.transmit);
        let mut is_scattered = is_scattered | (inside & surely_scattered);
        let mut goes_on = is_scattered | is_passed | (inside & surely_on);
        let factor = Lane::select(is_scattered, odds.scatter_weight, odds.transmit_weight);
        self.weight = Lane::select(goes_on, weight * factor, weight);
        if let Some(below) = world.particle.roulette {
            let (below, size) = (one.each(below), self.weight.size());
            let plays = goes_on & !below.at_most(size);
            let survives = (self.numbers.uniform_where(plays) * below).below(size);
            let kept = Lane::select(self.weight.below(zero), -below, below);
            self.weight = Lane::select(plays & survives, kept, self.weight);
            goes_on &= !plays | survives;
            is_scattered &= goes_on;
        }
        self.ended = !goes_on;
        self.turns = is_scattered;
        if is_scattered.to_bitmask() != 0 {
            self.scatter(world.scene, is_scattered, place);
        }
    }

    /// Turns those that a mask names.
    #[inline(always)]
    fn scatter(&mut self, scene: &Scene, which: mask64x8<S>, place: Points<S>) {
        let cosine = scene.phase.cosine(self.numbers.uniform_where(which));
        let turns = self.numbers.uniform_where(which);
        let turned = frame::turned_lanes(self.flights.direction, cosine, turns);
        for axis in 0..3 {
            let (from, to) = (&mut self.flights.origin[axis], &mut self.flights.direction[axis]);
            *from = Lane::select(which, place[axis], *from);
            *to = Lane::select(which, turned[axis], *to);
        }
    }

    /// Makes draws of those that have ended, as bits; answers whose last ones these are.
    #[inline(always)]
    fn finish<T: Tally<SUMS>>(
        &mut self,
        world: &World<T>,
        (ended, inside): (u64, u64),
        buffer: &mut DrawBuffer,
    ) -> u64 {
        let mut rows = [[0.0; WIDTH]; SUMS];
        for (row, sum) in rows.iter_mut().zip(self.sums) {
            sum.store_slice(row);
        }
        collect(&rows, world.tally.channels(), (ended, inside), &mut self.slots, buffer)
    }
}

/// Writes the sums of walks that have ended into their draws.
#[inline(never)]
#[allow(clippy::cast_possible_truncation)] // one bit
fn collect(
    rows: &[[f64; WIDTH]],
    channels: &[usize],
    (ended, inside): (u64, u64),
    slots: &mut Slots,
    buffer: &mut DrawBuffer,
) -> u64 {
    slots.fill(ended, |Slot { lane, draw, steps }| {
        for (values, &sum) in buffer.values.iter_mut().zip(channels) {
            values[draw] = rows[sum][lane];
        }
        buffer.defects[draw] = 0.0;
        // The flight that leaves looks at nothing.
        buffer.lookups[draw] = steps + (inside >> lane & 1) as u32;
    })
}

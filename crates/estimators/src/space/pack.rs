//! Eight walks in space, step by step: what [`super::packet`] runs two of.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::exit::{Points, splat};
use super::flights::{Flights, Flown};
use super::packet::{World, collect};
use super::shadow::Shadows;
use super::tally::{Collision, Departure, Tally, add_where};
use crate::DrawBuffer;
use crate::kernels::packet::bank::{Numbers, Slots};
use media::phase::Phase;
use numeric::Lane;
use numeric::geometry::frame;
use numeric::pack::{self, WIDTH};
use numeric::twin::PAIR;

/// So many particles of a pack set out together: a direction costs more than a step. While fewer wait for it, the
/// others go on.
const TOGETHER: u32 = 3;

/// Eight walks.
pub struct Pack<S: Simd, const SUMS: usize> {
    /// Their streams.
    pub numbers: Numbers<S>,
    flights: Flights<S>,
    shadows: Shadows<S>,
    weight: f64x8<S>,
    sums: [f64x8<S>; SUMS],
    lookups: f64x8<S>,
    unscattered: mask64x8<S>,
    /// Who has ended in this step.
    pub ended: mask64x8<S>,
    /// Who was scattered in this step.
    scattered: mask64x8<S>,
    /// Whose shadow ray came to its end in this step.
    lit: mask64x8<S>,
    /// Who is to cast a shadow ray.
    aims: mask64x8<S>,
    /// Who is to turn and to set out.
    turns: mask64x8<S>,
    /// Who is to set out as it is.
    begins: mask64x8<S>,
}

impl<S: Simd, const SUMS: usize> Pack<S, SUMS> {
    #[inline(always)]
    pub fn begin<T: Tally<SUMS>>(simd: S, world: &World<T>, numbers: Numbers<S>) -> Self {
        let one = f64x8::splat(simd, 1.0);
        let (all, none) = (one.at_most(one), one.below(one));
        let mut pack = Self {
            numbers,
            flights: Flights::new(simd),
            shadows: Shadows::new(simd),
            weight: one,
            sums: [one.each(0.0); SUMS],
            lookups: one.each(0.0),
            unscattered: all,
            ended: all,
            scattered: none,
            lit: none,
            aims: none,
            turns: none,
            begins: none,
        };
        pack::outlined_if_narrow(
            simd,
            #[inline(always)]
            || {
                pack.begin_anew(simd, world);
                pack.redirect(world);
            },
        );
        pack
    }

    /// Those that have ended begin the next walk.
    #[inline(always)]
    pub fn begin_anew<T: Tally<SUMS>>(&mut self, simd: S, world: &World<T>) {
        let ended = self.ended;
        let [origin, direction] = world.tally.begin(simd, &mut self.numbers, ended);
        for axis in 0..3 {
            let (from, to) = (&mut self.flights.origin[axis], &mut self.flights.direction[axis]);
            *from = Lane::select(ended, origin[axis], *from);
            *to = Lane::select(ended, direction[axis], *to);
        }
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        self.weight = Lane::select(ended, one, self.weight);
        for sum in &mut self.sums {
            *sum = Lane::select(ended, zero, *sum);
        }
        self.lookups = Lane::select(ended, zero, self.lookups);
        self.unscattered |= ended;
    }

    /// Who waits for others to set out with.
    #[inline(always)]
    fn waits(&self) -> mask64x8<S> {
        self.aims | self.turns | self.begins
    }

    /// To the next tentative collision or out of the body; says where σ_t is asked for.
    #[inline(always)]
    pub fn fly<T: Tally<SUMS>>(
        &mut self,
        world: &World<T>,
        number: usize,
        points: &mut [[f64; PAIR]; 3],
    ) -> Flown<S> {
        let (waits, origin) = (self.waits(), self.flights.origin);
        let depth = -self.numbers.ln_uniform_where(!waits);
        let walks = if T::CASTS { !waits & !self.shadows.on } else { !waits };
        let mut flown = self.flights.fly(&world.ground, walks, depth);
        flown.place = chosen(walks, flown.place, origin);
        world.tally.flown(&mut self.sums, flown.length, self.weight);
        if let (true, Some(rays)) = (T::CASTS, &world.shadow_rays) {
            let (place, inside) = self.shadows.fly(rays, origin, depth);
            flown.place = chosen(self.shadows.on, place, flown.place);
            flown.inside |= inside;
        }
        for (axis, row) in points.iter_mut().enumerate() {
            flown.place[axis].store_slice(&mut row[number * WIDTH..][..WIDTH]);
        }
        flown
    }

    /// What becomes of each, given σ_t and the albedo where it has come to.
    #[inline(always)]
    pub fn collide<T: Tally<SUMS>>(
        &mut self,
        simd: S,
        world: &World<T>,
        flown: &Flown<S>,
        (extinction, albedo): (f64x8<S>, f64x8<S>),
    ) {
        let Flown { inside, sampling, place, .. } = *flown;
        let (zero, one) = (f64x8::splat(simd, 0.0), f64x8::splat(simd, 1.0));
        add_where(&mut self.lookups, inside, one);
        let casts = self.shadows.on;
        if let (true, Some(rays)) = (T::CASTS, &world.shadow_rays) {
            let numbers = &mut self.numbers;
            let found = self.shadows.collide(rays, numbers, (place, casts & inside), extinction);
            world.tally.lit(&mut self.sums, found, self.shadows.through);
            self.lit = found.0;
        }
        let walks = !(casts | self.waits());
        let (inside, left) = (inside & walks, walks & !inside);
        let (weight, ratio) = (self.weight, extinction / sampling);
        let at = Collision { inside, place, weight, ratio, albedo };
        world.tally.collided(&mut self.sums, &at);
        let direction = self.flights.direction;
        let unscattered = self.unscattered;
        let at = Departure { left, place, direction, weight, unscattered };
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
        self.ended = walks & !goes_on;
        self.scattered = is_scattered;
        self.unscattered &= !is_scattered;
        for (axis, from) in self.flights.origin.iter_mut().enumerate() {
            *from = Lane::select(is_scattered, place[axis], *from);
        }
    }

    /// Those that were scattered cast shadow rays, or turn, and these and those that begin set out, as soon as there
    /// are enough of them.
    ///
    /// Shadow rays and new directions are drawn, and clipped, together.
    #[inline(always)]
    pub fn redirect<T: Tally<SUMS>>(&mut self, world: &World<T>) {
        let (zero, origin) = (self.weight.each(0.0), self.flights.origin);
        let sets_out = self.scattered | self.ended;
        let turns = if world.tally.begins_turned() { sets_out } else { self.scattered };
        self.begins |= sets_out & !turns;
        if T::CASTS {
            world.tally.scattered(&mut self.sums, turns, origin);
            let is_nothing = self.weight.at_most(zero) & zero.at_most(self.weight);
            self.aims |= turns & !is_nothing;
            self.turns |= (turns & is_nothing) | self.lit;
        } else {
            self.turns |= turns;
        }
        let moves = self.waits();
        if moves.to_bitmask().count_ones() >= TOGETHER {
            self.set_out(world);
        }
    }

    /// All that wait set out.
    #[inline(always)]
    fn set_out<T: Tally<SUMS>>(&mut self, world: &World<T>) {
        let (zero, one) = (self.weight.each(0.0), self.weight.each(1.0));
        let (moves, origin) = (self.waits(), self.flights.origin);
        let (casts, turns, sets_out) = (self.aims, self.turns, self.turns | self.begins);
        let nobody = moves & !moves;
        (self.aims, self.turns, self.begins) = (nobody, nobody, nobody);
        let parallel = if T::CASTS { world.tally.parallel() } else { None };
        let draws = if parallel.is_some() { turns } else { turns | casts };
        let (mut direction, mut number) = (self.flights.direction, zero);
        if draws.any_true() {
            number = self.numbers.uniform_where(draws);
            direction = self.turned(world, (draws, number), casts);
        }
        if let Some(towards) = parallel {
            direction = chosen(casts, splat(zero.token(), towards), direction);
        }
        let reach = world.ground.reach([origin, direction], moves);
        if let (true, Some(rays)) = (T::CASTS, &world.shadow_rays) {
            let light = world.tally.aim(origin, number).light(direction, reach.stop);
            let (rays, from) = ((rays, &world.extinction), (origin, self.weight));
            let found = self.shadows.cast(rays, casts, &light, from, reach.ends);
            world.tally.lit(&mut self.sums, found, one);
            // Who needed no tracking turns next.
            self.turns = casts & !self.shadows.on;
        }
        self.flights.direction = chosen(turns, direction, self.flights.direction);
        self.flights.enter(&world.ground, sets_out, &reach);
    }

    /// New directions of those that a mask names, made of uniform numbers: of shadow rays that some of them cast, or
    /// of walks.
    #[inline(always)]
    fn turned<T: Tally<SUMS>>(
        &mut self,
        world: &World<T>,
        (which, number): (mask64x8<S>, f64x8<S>),
        casts: mask64x8<S>,
    ) -> Points<S> {
        let (mut axis, mut cosine) =
            (self.flights.direction, cosine_of(&world.scene.phase, number));
        if world.tally.begins_turned() {
            cosine = Lane::select(self.unscattered, world.tally.first_cosine(number), cosine);
        }
        if T::CASTS {
            let aim = world.tally.aim(self.flights.origin, number);
            (axis, cosine) =
                (chosen(casts, aim.axis, axis), Lane::select(casts, aim.cosine, cosine));
        }
        let turns = self.numbers.uniform_where(which);
        let turned = turned(axis, cosine, turns);
        chosen(which, turned, self.flights.direction)
    }

    /// Makes draws of those that have ended; answers whose last ones these are.
    #[inline(always)]
    pub fn finish<T: Tally<SUMS>>(
        &self,
        world: &World<T>,
        slots: &mut Slots,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        let ended = (self.ended.to_bitmask(), slots);
        collect(&self.sums, &self.lookups, world.tally.channels(), ended, buffer)
    }
}

/// [`Phase::cosine`], in a function of its own on AVX2.
#[inline(always)]
fn cosine_of<S: Simd>(phase: &Phase, number: f64x8<S>) -> f64x8<S> {
    pack::outlined_if_narrow(
        number.token(),
        #[inline(always)]
        move || phase.cosine(number),
    )
}

/// [`frame::turned_lanes`], in a function of its own on AVX2.
#[inline(always)]
fn turned<S: Simd>(direction: Points<S>, cosine: f64x8<S>, turns: f64x8<S>) -> Points<S> {
    pack::outlined_if_narrow(
        turns.token(),
        #[inline(always)]
        move || frame::turned_lanes(direction, cosine, turns),
    )
}

/// Points where a mask says so, else others.
#[inline(always)]
fn chosen<L: Lane>(mask: L::Mask, [a, b, c]: [L; 3], [x, y, z]: [L; 3]) -> [L; 3] {
    [L::select(mask, a, x), L::select(mask, b, y), L::select(mask, c, z)]
}

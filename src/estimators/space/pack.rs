//! Eight walks in space, step by step: what [`super::packet`] runs two of.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::flights::{Flights, Flown};
use super::packet::{World, collect};
use super::shadow::Shadows;
use super::tally::{Collision, Departure, Tally, add_where};
use crate::estimators::DrawBuffer;
use crate::geometry::frame;
use crate::kernels::packet::bank::{Numbers, Slots};
use crate::numeric::Lane;
use crate::numeric::pack::WIDTH;
use crate::numeric::twin::PAIR;

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
    /// Where their draws go.
    pub slots: Slots,
}

impl<S: Simd, const SUMS: usize> Pack<S, SUMS> {
    #[inline(always)]
    pub fn begin<T: Tally<SUMS>>(
        simd: S,
        world: &World<T>,
        numbers: Numbers<S>,
        slots: Slots,
    ) -> Self {
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
            slots,
        };
        pack.begin_anew(simd, world);
        pack.redirect(world);
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

    /// To the next tentative collision or out of the body; says where σ_t is asked for.
    #[inline(always)]
    pub fn fly<T: Tally<SUMS>>(
        &mut self,
        world: &World<T>,
        number: usize,
        points: &mut [[f64; PAIR]; 3],
    ) -> Flown<S> {
        let depth = -self.numbers.ln_uniform();
        let mut flown = self.flights.fly(&world.ground, depth);
        world.tally.flown(&mut self.sums, flown.length, self.weight);
        if let (true, Some(rays)) = (T::CASTS, &world.shadow_rays) {
            // Who casts a shadow ray does not walk: its flight begins anew when that has come to its end.
            let on = self.shadows.on;
            let (place, inside) = self.shadows.fly(rays, self.flights.origin, depth);
            for (axis, walked) in flown.place.iter_mut().enumerate() {
                *walked = Lane::select(on, place[axis], *walked);
            }
            flown.inside = (flown.inside & !on) | inside;
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
        let (inside, left) =
            if T::CASTS { (inside & !casts, !inside & !casts) } else { (inside, !inside) };
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
        self.ended = if T::CASTS { !goes_on & !casts } else { !goes_on };
        self.scattered = is_scattered;
        self.unscattered &= !is_scattered;
        for (axis, from) in self.flights.origin.iter_mut().enumerate() {
            *from = Lane::select(is_scattered, place[axis], *from);
        }
    }

    /// Those that were scattered cast shadow rays and turn, and these and those that begin set out.
    #[inline(always)]
    pub fn redirect<T: Tally<SUMS>>(&mut self, world: &World<T>) {
        let begins_turned = world.tally.begins_turned();
        let sets_out = self.scattered | self.ended;
        let (mut turns, mut sets_out) =
            (if begins_turned { sets_out } else { self.scattered }, sets_out);
        if let (true, Some(rays)) = (T::CASTS, &world.shadow_rays) {
            let zero = self.weight.each(0.0);
            world.tally.scattered(&mut self.sums, turns, self.flights.origin);
            let is_nothing = self.weight.at_most(zero) & zero.at_most(self.weight);
            let casts = turns & !is_nothing;
            if casts.to_bitmask() != 0 {
                let origin = self.flights.origin;
                let light = world.tally.light(&mut self.numbers, casts, origin);
                let found = self.shadows.cast(rays, casts, &light, (origin, self.weight));
                world.tally.lit(&mut self.sums, found, zero.each(1.0));
            }
            turns = (turns | self.lit) & !self.shadows.on;
            sets_out = (sets_out | self.lit) & !self.shadows.on;
        }
        if turns.to_bitmask() != 0 {
            self.turn(world, turns);
        }
        if sets_out.to_bitmask() != 0 {
            self.flights.enter(&world.ground, sets_out);
        }
    }

    /// Turns those that a mask names.
    #[inline(always)]
    fn turn<T: Tally<SUMS>>(&mut self, world: &World<T>, which: mask64x8<S>) {
        let number = self.numbers.uniform_where(which);
        let mut cosine = world.scene.phase.cosine(number);
        if world.tally.begins_turned() {
            cosine = Lane::select(self.ended, world.tally.first_cosine(number), cosine);
        }
        let turns = self.numbers.uniform_where(which);
        let turned = frame::turned_lanes(self.flights.direction, cosine, turns);
        for (axis, to) in self.flights.direction.iter_mut().enumerate() {
            *to = Lane::select(which, turned[axis], *to);
        }
    }

    /// Makes draws of those that have ended, as bits; answers whose last ones these are.
    #[inline(always)]
    pub fn finish<T: Tally<SUMS>>(
        &mut self,
        world: &World<T>,
        ended: u64,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        let channels = world.tally.channels();
        collect(&self.sums, &self.lookups, channels, (ended, &mut self.slots), buffer)
    }
}

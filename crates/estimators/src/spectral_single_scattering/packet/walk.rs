//! Eight walks, step by step.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::shadow::Shadows;
use super::{LOST, World};
use crate::kernels::packet::bank::{Numbers, Slots};
use crate::kernels::packet::hero::{number_of_hero, or_of_hero};
use crate::kernels::packet::kept::Keep;
use crate::kernels::packet::left::Left;
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::twin::PAIR;
use theory::ParticleRule;
use theory::spectral::chance::shares;

/// So many lanes cast their shadow rays together: to find where they lead costs more than a step. While fewer wait for it,
/// others are on their way.
const TOGETHER: u32 = 4;

/// Eight walks.
pub struct Pack<S: Simd> {
    pub numbers: Numbers<S>,
    pub slots: Slots,
    /// Which fly along the ray, which wait to cast a shadow ray, and which fly along one.
    walks: mask64x8<S>,
    aims: mask64x8<S>,
    pub casts: mask64x8<S>,
    shadows: Shadows<S>,
    /// Which met a collision in this step.
    inside: mask64x8<S>,
    number: f64x8<S>,
    /// How far they are along the ray.
    way: f64x8<S>,
    /// The number of each hero, its mean free path through σ̂ and its albedo.
    hero: f64x8<S>,
    path: f64x8<S>,
    albedo: f64x8<S>,
    /// As in a [`Path`](crate::kernels::hero::Path).
    length: f64x8<S>,
    collisions: f64x8<S>,
    weights: [f64x8<S>; MOST_CHANNELS],
    /// What they are to be.
    next: [f64x8<S>; MOST_CHANNELS],
    /// `σ_t/σ̂` of each channel on the ray.
    ratios: [f64x8<S>; MOST_CHANNELS],
    keep: Keep<S>,
}

impl<S: Simd> Pack<S> {
    /// All begin.
    #[inline(always)]
    pub fn begin<const ALL: bool>(
        simd: S,
        world: &World<ALL>,
        numbers: Numbers<S>,
        slots: Slots,
    ) -> Self {
        let (one, all) = (f64x8::splat(simd, 1.0), mask64x8::splat(simd, true));
        let from = one.each(world.support.from);
        let mut pack = Self {
            numbers,
            slots,
            walks: all,
            aims: !all,
            casts: !all,
            shadows: Shadows::new(&world.problem.channels[0], from),
            inside: all,
            number: one,
            way: from,
            hero: one,
            path: one,
            albedo: one,
            length: one,
            collisions: one,
            weights: [one; MOST_CHANNELS],
            next: [one; MOST_CHANNELS],
            ratios: [one; MOST_CHANNELS],
            keep: Keep::new(simd),
        };
        pack.begin_anew(world, all);
        pack
    }

    /// Those that have ended begin the next walk.
    #[inline(always)]
    pub fn begin_anew<const ALL: bool>(&mut self, world: &World<ALL>, which: mask64x8<S>) {
        let count = world.media.count;
        let (zero, one) = (self.length.each(0.0), self.length.each(1.0));
        let hero = match &world.law {
            Some(law) => law.choose(self.numbers.uniform_where(which)),
            None => zero,
        };
        let path = one / number_of_hero(hero, &world.media.majorants[..count]);
        let albedo = number_of_hero(hero, &world.albedos[..count]);
        let keep = self.keep;
        keep.put(&mut self.hero, which, hero);
        keep.put(&mut self.path, which, path);
        keep.put(&mut self.albedo, which, albedo);
        keep.put(&mut self.way, which, zero.each(world.support.from));
        keep.put(&mut self.length, which, zero);
        keep.put(&mut self.collisions, which, zero);
        self.walks |= which;
        if ALL {
            for weight in &mut self.weights[..count] {
                keep.put(weight, which, one);
            }
        }
        if world.tracks {
            for through in &mut self.shadows.through[..count] {
                keep.put(through, which, one);
            }
        }
    }

    /// All fly on; answers where they are on the ray, and writes where they are on their shadow rays.
    #[inline(always)]
    pub fn fly<const ALL: bool>(
        &mut self,
        world: &World<ALL>,
        points: &mut [[f64; PAIR]; 3],
        number: usize,
    ) -> f64x8<S> {
        let flies = self.walks | self.casts;
        let depth = -self.numbers.ln_uniform_where(flies);
        self.number = self.numbers.uniform_where(self.walks);
        let (from, to) = (depth.each(world.support.from), depth.each(world.support.to));
        let way = depth.times_plus(self.path, self.way);
        self.inside = self.walks & way.below(to);
        if self.casts.any_true() {
            let (casts, flight) = (self.casts, depth * self.path);
            let on_shadow = self.shadows.fly(self.keep, casts, flight, (points, number));
            self.inside |= on_shadow;
        }
        let way = Lane::select(self.walks & self.inside, way, from);
        let piece = Lane::select(self.walks & self.inside, way - self.way, depth.each(0.0));
        self.length += piece;
        self.keep.put(&mut self.way, self.walks, way);
        way
    }

    /// What becomes of each, given σ_t of all channels on the ray and on shadow rays; answers whose walks end.
    #[inline(always)]
    pub fn collide<const ALL: bool>(
        &mut self,
        world: &World<ALL>,
        on_ray: &[f64x8<S>; MOST_CHANNELS],
        on_shadow: &[f64x8<S>; MOST_CHANNELS],
    ) -> mask64x8<S> {
        let (count, one) = (world.media.count, self.length.each(1.0));
        let Self { inside, walks, casts, keep, .. } = *self;
        let collisions = self.collisions + 1.0;
        keep.put(&mut self.collisions, inside, collisions);
        let mut own = one;
        for (channel, &found) in on_ray[..count].iter().enumerate() {
            let ratio = found / one.each(world.media.majorants[channel]);
            self.ratios[channel] = ratio;
            own = or_of_hero(self.hero, channel, own, ratio);
        }
        let [scatters, passes] = self.chances(world, own);
        let met = walks & inside;
        let is_scattered = met & self.number.below(scatters);
        let is_null = met & !is_scattered & self.number.below(scatters + passes);
        if ALL {
            self.weigh(world, [is_scattered, is_null], [scatters, passes]);
        }
        let mut ends = walks & !is_scattered & !is_null;
        // What is not scattered is nowhere.
        keep.put(&mut self.way, ends, one.each(world.support.from));
        keep.put(&mut self.hero, ends, one.each(LOST));
        self.walks = (walks & !is_scattered) & !ends;
        if !world.tracks {
            return ends | is_scattered;
        }
        if casts.any_true() {
            for (channel, &found) in on_shadow[..count].iter().enumerate() {
                let kept = one - found / one.each(world.media.majorants[channel]);
                let through = self.shadows.through[channel] * kept;
                keep.put(&mut self.shadows.through[channel], casts & inside, through);
            }
            let arrived = casts & !inside;
            let length = self.length + self.shadows.length;
            keep.put(&mut self.length, arrived, length);
            self.casts &= inside;
            ends |= arrived;
        }
        self.aims |= is_scattered;
        let waiting = self.aims.to_bitmask().count_ones();
        if waiting >= TOGETHER || (waiting > 0 && !(self.walks | self.casts | ends).any_true()) {
            let (aims, none) = (self.aims, self.aims & !self.aims);
            let is_blocked = self.shadows.cast(keep, &world.problem.channels[0], (aims, self.way));
            self.casts |= is_blocked;
            self.aims = none;
            ends |= aims & !is_blocked;
        }
        ends
    }

    /// The chances to be scattered and to go straight on, given the heroes' ratios.
    #[inline(always)]
    fn chances<const ALL: bool>(&self, world: &World<ALL>, own: f64x8<S>) -> [f64x8<S>; 2] {
        let count = world.media.count;
        if ALL && let Some(chances) = world.walker.together() {
            let [passes, scatters, _] = chances.of_events(
                count,
                #[inline(always)]
                |channel| shares(self.ratios[channel], world.albedos[channel]),
                &self.weights,
            );
            return [scatters, passes];
        }
        let odds = ParticleRule::Analog.odds(own, self.albedo);
        [odds.scatter, odds.transmit]
    }

    /// What the events, of these chances, make of the densities, relative to the walker's.
    #[inline(always)]
    fn weigh<const ALL: bool>(
        &mut self,
        world: &World<ALL>,
        [is_scattered, is_null]: [mask64x8<S>; 2],
        [scatters, passes]: [f64x8<S>; 2],
    ) {
        let (count, mut own) = (world.media.count, self.length);
        for channel in 0..count {
            let (ratio, albedo) = (self.ratios[channel], world.albedos[channel]);
            let factor = Lane::select(is_null, own.each(1.0) - ratio, ratio * albedo);
            let next = self.weights[channel] * factor;
            self.next[channel] = next;
            own = or_of_hero(self.hero, channel, own, next);
        }
        if world.walker.together().is_some() {
            own = Lane::select(is_null, passes, scatters);
        }
        for channel in 0..count {
            let next = self.next[channel] / own;
            self.keep.put(&mut self.weights[channel], is_scattered | is_null, next);
        }
    }

    /// Walks that have ended leave what draws are made of; answers whose last ones these are.
    #[inline(always)]
    pub fn leave<const ALL: bool>(
        &mut self,
        world: &World<ALL>,
        ended: mask64x8<S>,
        left: &mut Left,
    ) -> u64 {
        let rest = [self.hero, self.length, self.collisions, self.way];
        let count = world.media.count;
        let weights = if ALL { &self.weights[..count] } else { &[] };
        let through = if world.tracks { &self.shadows.through[..count] } else { &[] };
        let ends = (ended.to_bitmask(), &mut self.slots);
        left.collect([&rest, weights, through], ends)
    }
}

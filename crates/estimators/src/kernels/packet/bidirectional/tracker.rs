//! Subpaths and connections by delta and ratio tracking, sixteen at a time: as `bidirectional_rod/subpath`.
//!
//! All that is made stays where it is: what is copied from place to place would be copied by a call, which costs a kernel
//! its registers.

use fearless_simd::{Simd, SimdMask, f64x8, mask64x8};

use super::Techniques;
use super::path::Paths;
use crate::kernels::packet::bank::Numbers;
use crate::setup::Setup;
use media::{Lookups, even};
use numeric::rng::PACKS;
use numeric::{Lane, Twin};
use theory::problems::BidirectionalRod;
use theory::problems::bidirectional_rod::{HIGHEST_ORDER, Sensor};

/// From where subpaths begin.
#[derive(Clone, Copy, PartialEq)]
pub enum Side {
    /// The light.
    Light = 0,
    /// The sensor.
    Camera = 1,
}

/// Real collisions of eight walks.
#[derive(Clone, Copy)]
pub struct Subpaths<S: Simd> {
    /// Where, as distances along the ray.
    pub at: [f64x8<S>; HIGHEST_ORDER],
    /// The direction of each flight: to each collision, and out of the rod.
    pub is_forward: [mask64x8<S>; HIGHEST_ORDER + 1],
    /// `∏ (1 − σ_t/σ̂)` over the null vertices of each flight.
    pub nulls: [f64x8<S>; HIGHEST_ORDER + 1],
    /// The ways of the walks to their last collisions.
    pub last: f64x8<S>,
    /// Which have all collisions that were asked for.
    pub whole: mask64x8<S>,
    /// Which of them left the rod next.
    pub left: mask64x8<S>,
}

/// Tracking through the rod of one experiment.
pub struct Tracker<'a, S: Simd> {
    pub simd: S,
    pub page: Techniques,
    pub setup: &'a Setup<BidirectionalRod>,
    pub medium: &'a Lookups<'a>,
    pub sampling: &'a even::Even,
    pub numbers: [Numbers<S>; PACKS],
    pub lookups: [f64x8<S>; PACKS],
    /// Those from the light and those from the sensor.
    pub subpaths: [[Subpaths<S>; PACKS]; 2],
    pub paths: [Paths<S>; PACKS],
}

/// Walks of both packs, and which of them are on their way.
#[derive(Clone, Copy)]
struct Walks<S: Simd> {
    ways: [f64x8<S>; PACKS],
    is_forward: [mask64x8<S>; PACKS],
    flying: [mask64x8<S>; PACKS],
}

impl<S: Simd> Tracker<'_, S> {
    /// Makes walks of some to so many collisions and, where that is asked for, one flight beyond.
    #[inline(always)]
    pub fn walk(
        &mut self,
        side: Side,
        [collisions, beyond]: [usize; 2],
        which: [mask64x8<S>; PACKS],
    ) {
        let problem = &*self.setup.problem;
        let begins_forward = side == Side::Light || problem.sensor == Sensor::Reflected;
        let zero = self.lookups[0].each(0.0);
        let (albedo, forward) =
            (zero.each(problem.albedo), zero.each(problem.albedo * problem.forward));
        let begin = if begins_forward { self.sampling.from } else { self.sampling.to };
        let nobody = which[0] & !which[0];
        let direction = if begins_forward { !nobody } else { nobody };
        let (ways, is_forward) = ([zero.each(begin); PACKS], [direction; PACKS]);
        let mut walks = Walks { ways, is_forward, flying: which };
        let side = side as usize;
        for pack in 0..PACKS {
            let subpath = &mut self.subpaths[side][pack];
            (subpath.last, subpath.whole, subpath.left) = (ways[pack], which[pack], nobody);
        }
        for flight in 0..collisions + beyond {
            if flight > 0 {
                for pack in 0..PACKS {
                    let number = self.numbers[pack].uniform_where(walks.flying[pack]);
                    walks.flying[pack] &= number.below(albedo);
                    walks.is_forward[pack] ^= walks.flying[pack] & !number.below(forward);
                }
            }
            let (flown, nulls) = self.fly(walks);
            for (pack, &nulls) in nulls.iter().enumerate() {
                let subpath = &mut self.subpaths[side][pack];
                subpath.is_forward[flight] = walks.is_forward[pack];
                subpath.nulls[flight] = nulls;
                if flight < collisions {
                    subpath.at[flight] = self.sampling.spread(flown.ways[pack]);
                    subpath.last = flown.ways[pack];
                    subpath.whole = flown.flying[pack];
                } else {
                    subpath.left = walks.flying[pack] & !flown.flying[pack];
                }
            }
            walks = flown;
        }
    }

    /// Some fly to their next real collisions, or out of the rod: where they are, those who collided being on their way,
    /// and the products over null vertices.
    #[inline(always)]
    fn fly(&mut self, mut walks: Walks<S>) -> (Walks<S>, [f64x8<S>; PACKS]) {
        let one = self.lookups[0].each(1.0);
        let nobody = walks.flying[0] & !walks.flying[0];
        let (mut nulls, mut real) = ([one; PACKS], [nobody; PACKS]);
        while (walks.flying[0] | walks.flying[1]).any_true() {
            walks = self.step(walks);
            let inside = walks.flying;
            let found = self.look_up(&walks);
            for pack in 0..PACKS {
                let ratio = found[pack] / one.each(self.sampling.value);
                let number = self.numbers[pack].uniform_where(inside[pack]);
                let collides = inside[pack] & number.below(ratio);
                walks.flying[pack] = inside[pack] & !collides;
                let passed = nulls[pack] * (one - ratio);
                nulls[pack] = Lane::select(walks.flying[pack], passed, nulls[pack]);
                real[pack] |= collides;
            }
        }
        walks.flying = real;
        (walks, nulls)
    }

    /// Those on their way fly to their next tentative collisions; only who is still inside is then.
    #[inline(always)]
    fn step(&mut self, mut walks: Walks<S>) -> Walks<S> {
        let zero = self.lookups[0].each(0.0);
        let (from, to) = (zero.each(self.sampling.from), zero.each(self.sampling.to));
        let path = zero.each(1.0 / self.sampling.value);
        for pack in 0..PACKS {
            let (which, is_forward) = (walks.flying[pack], walks.is_forward[pack]);
            let depth = -self.numbers[pack].ln_uniform_where(which);
            let signed = Lane::select(is_forward, depth, -depth);
            // The others stay where they are.
            let way = Lane::select(which, signed, zero).times_plus(path, walks.ways[pack]);
            let inside = (is_forward & way.below(to)) | (!is_forward & from.below(way));
            (walks.ways[pack], walks.flying[pack]) = (way, which & inside);
        }
        walks
    }

    /// σ_t where those are that are on their way.
    #[inline(always)]
    fn look_up(&mut self, walks: &Walks<S>) -> [f64x8<S>; PACKS] {
        let (zero, one) = (self.lookups[0].each(0.0), self.lookups[0].each(1.0));
        // Beyond both ends there is no field to look at.
        let from = zero.each(self.sampling.from);
        let mut places = [self.sampling.spread(from); PACKS];
        for (pack, place) in places.iter_mut().enumerate() {
            let (which, here) = (walks.flying[pack], self.sampling.spread(walks.ways[pack]));
            *place = Lane::select(which, here, *place);
            self.lookups[pack] += Lane::select(which, one, zero);
        }
        let Twin(first, second) = self.medium.pair(self.simd, Twin(places[0], places[1]));
        [first, second]
    }

    /// Connects the ends of the subpaths of a technique by ratio tracking.
    #[inline(always)]
    pub fn connect(&mut self, s: usize, flying: [mask64x8<S>; PACKS]) {
        let one = self.lookups[0].each(1.0);
        let [first, second] = &self.subpaths[Side::Light as usize];
        let is_forward = [self.paths[0].is_forward[s - 1], self.paths[1].is_forward[s - 1]];
        let to = [self.paths[0].at[s], self.paths[1].at[s]];
        let mut walks = Walks { ways: [first.last, second.last], is_forward, flying };
        let mut nulls = [one; PACKS];
        while (walks.flying[0] | walks.flying[1]).any_true() {
            walks = self.step(walks);
            for pack in 0..PACKS {
                let (t, is_forward) = (self.sampling.spread(walks.ways[pack]), is_forward[pack]);
                walks.flying[pack] &=
                    (is_forward & t.below(to[pack])) | (!is_forward & to[pack].below(t));
            }
            let found = self.look_up(&walks);
            for pack in 0..PACKS {
                let passed = nulls[pack] * (one - found[pack] / one.each(self.sampling.value));
                nulls[pack] = Lane::select(walks.flying[pack], passed, nulls[pack]);
            }
        }
        for (pack, &nulls) in nulls.iter().enumerate() {
            self.paths[pack].transmittance[s - 1] = nulls;
        }
    }
}

//! Subpaths and connections by delta and ratio tracking, sixteen at a time: as [`super::super::subpath`].

use fearless_simd::{Simd, SimdMask, f64x8, mask64x8};

use super::Page;
use super::path::Paths;
use crate::estimators::Setup;
use crate::kernels::packet::bank::Numbers;
use crate::media::Lookups;
use crate::media::course::{BothWays, Course, Even};
use crate::numeric::{Lane, Twin};
use crate::problems::BidirectionalRod;
use crate::problems::bidirectional_rod::{HIGHEST_ORDER, Sensor};
use crate::rng::PACKS;

/// Real collisions of eight walks.
#[derive(Clone, Copy)]
pub struct Subpaths<'a, S: Simd> {
    /// Where, as distances along the ray.
    pub at: [f64x8<S>; HIGHEST_ORDER],
    /// The direction of each flight: to each collision, and out of the rod.
    pub is_forward: [mask64x8<S>; HIGHEST_ORDER + 1],
    /// `∏ (1 − σ_t/σ̂)` over the null vertices of each flight.
    pub nulls: [f64x8<S>; HIGHEST_ORDER + 1],
    /// The walks at their last collisions.
    pub last: Even<'a, S>,
    /// Which have all collisions that were asked for.
    pub whole: mask64x8<S>,
    /// Which of them left the rod next.
    pub left: mask64x8<S>,
}

/// Tracking through the rod of one experiment.
pub struct Tracker<'a, S: Simd> {
    pub simd: S,
    pub page: Page,
    pub setup: &'a Setup<BidirectionalRod>,
    pub medium: &'a Lookups<'a>,
    pub begin: Even<'a, S>,
    pub numbers: [Numbers<S>; PACKS],
    pub lookups: [f64x8<S>; PACKS],
}

impl<'a, S: Simd> Tracker<'a, S> {
    /// Walks of some to so many collisions and, where that is asked for, one flight beyond.
    #[inline(always)]
    pub fn subpaths(
        &mut self,
        from_light: bool,
        [collisions, beyond]: [usize; 2],
        mut which: [mask64x8<S>; PACKS],
    ) -> [Subpaths<'a, S>; PACKS] {
        let problem = &self.setup.problem;
        let [albedo, forward] = [problem.albedo, problem.albedo * problem.forward];
        let begins_forward = from_light || problem.sensor == Sensor::Reflected;
        let begin = if begins_forward { self.begin } else { self.begin.from_end() };
        let zero = self.lookups[0].each(0.0);
        let nobody = which[0] & !which[0];
        let mut is_forward = [if begins_forward { !nobody } else { nobody }; PACKS];
        let fresh = Subpaths {
            at: [zero; HIGHEST_ORDER],
            is_forward: [is_forward[0]; HIGHEST_ORDER + 1],
            nulls: [zero.each(1.0); HIGHEST_ORDER + 1],
            last: begin,
            whole: nobody,
            left: nobody,
        };
        let mut subpaths = [fresh; PACKS];
        for (pack, subpath) in subpaths.iter_mut().enumerate() {
            subpath.whole = which[pack];
        }
        for flight in 0..collisions + beyond {
            if flight > 0 {
                for (pack, numbers) in self.numbers.iter_mut().enumerate() {
                    let number = numbers.uniform_where(which[pack]);
                    which[pack] &= number.below(zero.each(albedo));
                    is_forward[pack] ^= which[pack] & !number.below(zero.each(forward));
                }
            }
            let mut courses = [subpaths[0].last, subpaths[1].last];
            let (nulls, real) = self.fly(&mut courses, is_forward, which);
            for (pack, subpath) in subpaths.iter_mut().enumerate() {
                subpath.is_forward[flight] = is_forward[pack];
                subpath.nulls[flight] = nulls[pack];
                if flight < collisions {
                    subpath.at[flight] = courses[pack].reached();
                    subpath.last = courses[pack];
                    subpath.whole = real[pack];
                } else {
                    subpath.left = which[pack] & !real[pack];
                }
            }
            which = real;
        }
        subpaths
    }

    /// Some fly to their next real collisions, or out of the rod: the products over null vertices, and who collided.
    #[inline(always)]
    fn fly(
        &mut self,
        courses: &mut [Even<'a, S>; PACKS],
        is_forward: [mask64x8<S>; PACKS],
        mut flying: [mask64x8<S>; PACKS],
    ) -> ([f64x8<S>; PACKS], [mask64x8<S>; PACKS]) {
        let one = self.lookups[0].each(1.0);
        let (mut nulls, mut real) = ([one; PACKS], [flying[0] & !flying[0]; PACKS]);
        while (flying[0] | flying[1]).any_true() {
            let inside = self.step(courses, is_forward, flying);
            let found = self.look_up(courses, inside);
            for pack in 0..PACKS {
                let ratio = found[pack] / courses[pack].sampling();
                let number = self.numbers[pack].uniform_where(inside[pack]);
                let collides = inside[pack] & number.below(ratio);
                flying[pack] = inside[pack] & !collides;
                let passed = nulls[pack] * (one - ratio);
                nulls[pack] = Lane::select(flying[pack], passed, nulls[pack]);
                real[pack] |= collides;
            }
        }
        (nulls, real)
    }

    /// Some fly to their next tentative collisions; answers who is still inside.
    #[inline(always)]
    fn step(
        &mut self,
        courses: &mut [Even<'a, S>; PACKS],
        is_forward: [mask64x8<S>; PACKS],
        which: [mask64x8<S>; PACKS],
    ) -> [mask64x8<S>; PACKS] {
        let mut inside = which;
        for (pack, course) in courses.iter_mut().enumerate() {
            let depth = -self.numbers[pack].ln_uniform_where(which[pack]);
            let before = *course;
            inside[pack] &= course.fly_either_way(depth, is_forward[pack]);
            course.stand_as(!which[pack], &before);
        }
        inside
    }

    /// σ_t where some are.
    #[inline(always)]
    fn look_up(
        &mut self,
        courses: &[Even<'a, S>; PACKS],
        which: [mask64x8<S>; PACKS],
    ) -> [f64x8<S>; PACKS] {
        // Beyond both ends there is no field to look at.
        let mut places = [self.begin.reached(); PACKS];
        for pack in 0..PACKS {
            places[pack] = Lane::select(which[pack], courses[pack].reached(), places[pack]);
            let lookups = self.lookups[pack];
            self.lookups[pack] = Lane::select(which[pack], lookups + 1.0, lookups);
        }
        let Twin(first, second) = self.medium.pair(self.simd, Twin(places[0], places[1]));
        [first, second]
    }

    /// Connects the ends of subpaths by ratio tracking.
    #[inline(always)]
    pub fn connect(
        &mut self,
        s: usize,
        mut courses: [Even<'a, S>; PACKS],
        paths: [&mut Paths<S>; PACKS],
        mut flying: [mask64x8<S>; PACKS],
    ) {
        let one = self.lookups[0].each(1.0);
        let is_forward = [paths[0].is_forward[s - 1], paths[1].is_forward[s - 1]];
        let (to, mut nulls) = ([paths[0].at[s], paths[1].at[s]], [one; PACKS]);
        while (flying[0] | flying[1]).any_true() {
            flying = self.step(&mut courses, is_forward, flying);
            for pack in 0..PACKS {
                let t = courses[pack].reached();
                let before = (is_forward[pack] & t.below(to[pack]))
                    | (!is_forward[pack] & to[pack].below(t));
                flying[pack] &= before;
            }
            let found = self.look_up(&courses, flying);
            for pack in 0..PACKS {
                let passed = nulls[pack] * (one - found[pack] / courses[pack].sampling());
                nulls[pack] = Lane::select(flying[pack], passed, nulls[pack]);
            }
        }
        for (pack, path) in paths.into_iter().enumerate() {
            path.transmittance[s - 1] = nulls[pack];
        }
    }
}

//! Real collisions as scattering points: delta tracking, alone or after a point from the light.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Sums};
use crate::estimators::packet::bank::Numbers;
use crate::estimators::single_scattering::source_driven::point;
use crate::estimators::space::shadow::Found;
use crate::estimators::space::tally::add_where;
use crate::numeric::Lane;

/// Eight walks to the first real collision.
pub struct Collisions<'a, S: Simd, const SOURCE: bool> {
    world: World<'a>,
    walk: Walk<'a, S>,
    looks: mask64x8<S>,
    done: mask64x8<S>,
    /// Whose point is the one from the light.
    is_first: mask64x8<S>,
    s: f64x8<S>,
    extinction: f64x8<S>,
    number: f64x8<S>,
}

impl<'a, S: Simd, const SOURCE: bool> Collisions<'a, S, SOURCE> {
    /// None has begun.
    #[inline(always)]
    pub fn new(simd: S, (world, walk): (World<'a>, Walk<'a, S>)) -> Self {
        let (zero, none) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        let (looks, done, is_first) = (none, none, none);
        let (s, extinction, number) = (walk.t, zero, zero);
        Self { world, walk, looks, done, is_first, s, extinction, number }
    }
}

impl<S: Simd, const SOURCE: bool> Page<S> for Collisions<'_, S, SOURCE> {
    #[inline(always)]
    fn begin(&mut self, numbers: &mut Numbers<S>, which: mask64x8<S>) {
        if SOURCE {
            let s = point(&self.world.setup.problem, numbers.uniform_where(which));
            self.s = Lane::select(which, s, self.s);
            self.looks |= which;
            self.is_first |= which;
        } else {
            self.walk.begin(which);
        }
    }

    #[inline(always)]
    fn flies(&self) -> mask64x8<S> {
        self.walk.on
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S> {
        self.number = numbers.uniform_where(flies);
        let t = self.walk.fly(flies, depth);
        if SOURCE { Lane::select(self.looks, self.s, t) } else { t }
    }

    #[inline(always)]
    fn collide(
        &mut self,
        _: &mut Numbers<S>,
        _: mask64x8<S>,
        extinction: f64x8<S>,
        sums: &mut Sums<S>,
    ) -> (mask64x8<S>, f64x8<S>) {
        let (zero, one) = (extinction.each(0.0), extinction.each(1.0));
        let inside = self.walk.inside;
        let hits = inside & (self.number * self.walk.sampling()).below(extinction);
        let escapes = self.walk.flew & !inside;
        add_where(&mut sums.lookups, inside | self.looks, one);
        self.walk.on &= !(hits | escapes);
        self.done |= escapes;
        self.s = Lane::select(hits, self.walk.t, self.s);
        let mut casts = hits;
        if SOURCE {
            let scatters = self.looks & zero.below(extinction);
            let walks = self.looks & !scatters;
            if walks.to_bitmask() != 0 {
                self.is_first &= !walks;
                self.walk.begin(walks);
            }
            self.looks = self.looks & !self.looks;
            casts |= scatters;
            self.extinction = Lane::select(casts, extinction, self.extinction);
        }
        (casts, self.s)
    }

    #[inline(always)]
    fn lit(&mut self, (which, light): Found<S>, sums: &mut Sums<S>) {
        let problem = &*self.world.setup.problem;
        let source = problem.source(self.s);
        if !SOURCE {
            add_where(&mut sums.value, which, source * light);
            self.done |= which;
            return;
        }
        let collision = self.extinction * self.world.transmittance(self.s, which);
        let density = problem.equiangular_density(self.s) + collision;
        add_where(&mut sums.value, which, collision * source * light / density);
        let walks = which & self.is_first;
        self.is_first &= !walks;
        self.walk.begin(walks);
        self.done |= which & !walks;
    }

    #[inline(always)]
    fn finish(&mut self) -> [mask64x8<S>; 2] {
        let done = self.done;
        self.done = done & !done;
        [done, done]
    }
}

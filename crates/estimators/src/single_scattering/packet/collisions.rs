//! Real collisions as scattering points: delta tracking.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Pages, Sums};
use crate::kernels::packet::bank::Numbers;
use crate::single_scattering::technique::Absorption;
use crate::space::shadow::Found;
use crate::space::tally::add_where;
use numeric::Lane;

/// Eight walks to the first real collision.
pub struct Collisions<'a, S: Simd> {
    world: World<'a>,
    walk: Walk<'a, S>,
    /// The chance that it scatters.
    scatters: f64,
    done: mask64x8<S>,
    s: f64x8<S>,
    number: f64x8<S>,
}

/// Delta tracking.
#[derive(Clone, Copy)]
pub struct Technique {
    /// What absorption does.
    pub absorption: Absorption,
}

impl<'a> Pages<'a> for Technique {
    type Page<S: Simd> = Collisions<'a, S>;

    #[inline(always)]
    fn page<S: Simd>(self, simd: S, world: World<'a>, walk: Walk<'a, S>) -> Self::Page<S> {
        let (zero, done) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        let scatters = self.absorption.scatters(world.setup.problem.albedo());
        Collisions { world, walk, scatters, done, s: walk.t, number: zero }
    }
}

impl<S: Simd> Page<S> for Collisions<'_, S> {
    #[inline(always)]
    fn begin(&mut self, _: &mut Numbers<S>, which: mask64x8<S>, _: &mut Sums<S>) {
        self.walk.begin(which);
    }

    #[inline(always)]
    fn flies(&self) -> mask64x8<S> {
        self.walk.on
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S> {
        self.number = numbers.uniform_where(flies);
        self.walk.fly(flies, depth)
    }

    #[inline(always)]
    fn collide(
        &mut self,
        _: &mut Numbers<S>,
        _: mask64x8<S>,
        extinction: f64x8<S>,
        sums: &mut Sums<S>,
    ) -> (mask64x8<S>, f64x8<S>) {
        let inside = self.walk.inside;
        let threshold = self.number * self.walk.sampling();
        let real = inside & threshold.below(extinction);
        let hits = real & threshold.below(extinction * self.scatters);
        let escapes = self.walk.flew & !inside;
        add_where(&mut sums.lookups, inside, extinction.each(1.0));
        self.walk.on &= !(real | escapes);
        self.done |= (real & !hits) | escapes;
        self.s = Lane::select(hits, self.walk.t, self.s);
        (hits, self.s)
    }

    #[inline(always)]
    fn lit(&mut self, (which, light): Found<S>, sums: &mut Sums<S>) {
        let source = self.world.setup.problem.source(self.s) / light.each(self.scatters);
        add_where(&mut sums.value, which, source * light);
        self.done |= which;
    }

    #[inline(always)]
    fn done(&mut self) -> &mut mask64x8<S> {
        &mut self.done
    }
}

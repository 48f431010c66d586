//! All interaction points of a walk as scattering points: attenuation-driven, or one of them by resampling.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Pages, Sums};
use crate::kernels::packet::bank::Numbers;
use crate::space::shadow::Found;
use crate::space::tally::add_where;
use numeric::Lane;

/// Eight walks to the end of the ray.
pub struct Interactions<'a, S: Simd, const RESAMPLED: bool> {
    world: World<'a>,
    walk: Walk<'a, S>,
    done: mask64x8<S>,
    /// T̂.
    weight: f64x8<S>,
    /// The point that casts a shadow ray, or would if it were the last.
    s: f64x8<S>,
    /// What it is worth.
    worth: f64x8<S>,
    /// `Σ|y|`.
    sum: f64x8<S>,
}

/// Attenuation-driven, resampled or not.
#[derive(Clone, Copy)]
pub struct Technique<const RESAMPLED: bool>;

impl<'a, const RESAMPLED: bool> Pages<'a> for Technique<RESAMPLED> {
    type Page<S: Simd> = Interactions<'a, S, RESAMPLED>;

    #[inline(always)]
    fn page<S: Simd>(self, simd: S, world: World<'a>, walk: Walk<'a, S>) -> Self::Page<S> {
        let (zero, done) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        Interactions { world, walk, done, weight: zero, s: walk.t, worth: zero, sum: zero }
    }
}

impl<S: Simd, const RESAMPLED: bool> Page<S> for Interactions<'_, S, RESAMPLED> {
    #[inline(always)]
    fn begin(&mut self, _: &mut Numbers<S>, which: mask64x8<S>, _: &mut Sums<S>) {
        self.walk.begin(which);
        self.weight = Lane::select(which, self.weight.each(1.0), self.weight);
        self.sum = Lane::select(which, self.sum.each(0.0), self.sum);
    }

    #[inline(always)]
    fn flies(&self) -> mask64x8<S> {
        self.walk.on
    }

    #[inline(always)]
    fn fly(&mut self, _: &mut Numbers<S>, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S> {
        self.walk.fly(flies, depth)
    }

    #[inline(always)]
    fn collide(
        &mut self,
        numbers: &mut Numbers<S>,
        _: mask64x8<S>,
        extinction: f64x8<S>,
        sums: &mut Sums<S>,
    ) -> (mask64x8<S>, f64x8<S>) {
        let (zero, one) = (extinction.each(0.0), extinction.each(1.0));
        let (inside, t, world) = (self.walk.inside, self.walk.t, &self.world);
        add_where(&mut sums.lookups, inside, one);
        let scatters = inside & zero.below(extinction);
        let source = extinction * world.setup.problem.source(t) / self.walk.sampling();
        let worth = self.weight * world.controlled(t) * source;
        let mut chosen = scatters;
        if RESAMPLED {
            add_where(&mut self.sum, scatters, worth.size());
            let number = numbers.uniform_where(scatters);
            chosen &= (number * self.sum).below(worth.size());
        }
        self.s = Lane::select(chosen, t, self.s);
        self.worth = Lane::select(chosen, worth, self.worth);
        let weight = self.weight * self.walk.kept(world, extinction);
        self.weight = Lane::select(inside, weight, self.weight);
        let escapes = self.walk.flew & !inside;
        self.walk.on &= !escapes;
        if !RESAMPLED {
            self.done |= escapes;
            return (chosen, self.s);
        }
        let is_nothing = escapes & self.sum.at_most(zero);
        self.done |= is_nothing;
        (escapes & !is_nothing, self.s)
    }

    #[inline(always)]
    fn lit(&mut self, (which, light): Found<S>, sums: &mut Sums<S>) {
        if RESAMPLED {
            // The one point's value is the draw's, its sign included where it is 0.
            let is_negative = self.worth.below(self.worth.each(0.0));
            let worth = Lane::select(is_negative, -self.sum, self.sum);
            sums.value = Lane::select(which, worth * light, sums.value);
            self.done |= which;
        } else {
            add_where(&mut sums.value, which, self.worth * light);
        }
    }

    #[inline(always)]
    fn done(&mut self) -> &mut mask64x8<S> {
        &mut self.done
    }
}

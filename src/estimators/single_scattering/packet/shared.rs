//! Several points from the light on one walk.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Sums};
use crate::estimators::single_scattering::shared_walk::MOST;
use crate::estimators::single_scattering::source_driven::point;
use crate::estimators::space::shadow::Found;
use crate::estimators::space::tally::add_where;
use crate::kernels::packet::bank::Numbers;
use crate::numeric::Lane;

/// Eight walks that pass their points.
pub struct Shared<'a, S: Simd> {
    world: World<'a>,
    walk: Walk<'a, S>,
    done: mask64x8<S>,
    count: usize,
    /// The points that lie ahead, ascending; then infinity.
    ahead: [f64x8<S>; MOST],
    /// Whose last flight has been made and not yet looked at.
    pending: mask64x8<S>,
    /// Where it has led; infinite beyond the end.
    reached: f64x8<S>,
    is_point: mask64x8<S>,
    is_collision: mask64x8<S>,
    weight: f64x8<S>,
    s: f64x8<S>,
    worth: f64x8<S>,
}

impl<'a, S: Simd> Shared<'a, S> {
    /// None has begun.
    #[inline(always)]
    pub fn new(simd: S, (world, walk): (World<'a>, Walk<'a, S>), count: usize) -> Self {
        let (zero, none) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        Self {
            world,
            walk,
            done: none,
            count,
            ahead: [zero; MOST],
            pending: none,
            reached: zero,
            is_point: none,
            is_collision: none,
            weight: zero,
            s: walk.t,
            worth: zero,
        }
    }
}

impl<S: Simd> Page<S> for Shared<'_, S> {
    #[inline(always)]
    fn begin(&mut self, numbers: &mut Numbers<S>, which: mask64x8<S>) {
        let problem = &*self.world.setup.problem;
        for number in 0..self.count {
            // Insertion: the larger one of each pair goes on.
            let mut s = point(problem, numbers.uniform_where(which));
            for place in &mut self.ahead[..number] {
                let larger = place.or_more(s);
                *place = Lane::select(which, place.or_less(s), *place);
                s = larger;
            }
            let place = &mut self.ahead[number];
            *place = Lane::select(which, s, *place);
        }
        self.walk.begin(which);
        self.weight = Lane::select(which, self.weight.each(1.0), self.weight);
    }

    #[inline(always)]
    fn flies(&self) -> mask64x8<S> {
        self.walk.on & !self.pending
    }

    #[inline(always)]
    fn fly(&mut self, _: &mut Numbers<S>, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S> {
        let from = self.walk.fly(flies, depth);
        let endless = depth.each(f64::INFINITY);
        let reached = Lane::select(self.walk.inside, self.walk.t, endless);
        self.reached = Lane::select(flies, reached, self.reached);
        self.pending |= flies;
        let next = self.ahead[0];
        let is_ahead = next.below(endless);
        self.is_point = is_ahead & next.at_most(self.reached);
        self.is_collision = !self.is_point & self.reached.below(endless);
        let inside =
            Lane::select(self.is_collision, self.reached, depth.each(self.world.support.from));
        self.walk.t = Lane::select(self.is_collision, inside, from);
        Lane::select(self.is_point, next, inside)
    }

    #[inline(always)]
    fn collide(
        &mut self,
        _: &mut Numbers<S>,
        active: mask64x8<S>,
        extinction: f64x8<S>,
        sums: &mut Sums<S>,
    ) -> (mask64x8<S>, f64x8<S>) {
        let (zero, one) = (extinction.each(0.0), extinction.each(1.0));
        let active = active & self.walk.on;
        let (is_point, is_collision) = (active & self.is_point, active & self.is_collision);
        add_where(&mut sums.lookups, is_point | is_collision, one);
        let (world, s) = (&self.world, self.ahead[0]);
        let problem = &*world.setup.problem;
        let source = extinction * problem.source(s) / problem.equiangular_density(s);
        let share = one.each(1.0 / self.count as f64);
        let worth = share * self.weight * world.controlled(s) * source;
        self.worth = Lane::select(is_point, worth, self.worth);
        self.s = Lane::select(is_point, s, self.s);
        for place in 1..=self.count {
            let next = if place < self.count { self.ahead[place] } else { one.each(f64::INFINITY) };
            self.ahead[place - 1] = Lane::select(is_point, next, self.ahead[place - 1]);
        }
        let weight = self.weight * self.walk.kept(world, extinction);
        self.weight = Lane::select(is_collision, weight, self.weight);
        let ends = active & !is_point & !is_collision;
        self.pending &= !(is_collision | ends);
        self.walk.on &= !ends;
        self.done |= ends;
        (is_point & zero.below(extinction), self.s)
    }

    #[inline(always)]
    fn lit(&mut self, (which, light): Found<S>, sums: &mut Sums<S>) {
        add_where(&mut sums.value, which, self.worth * light);
    }

    #[inline(always)]
    fn finish(&mut self) -> [mask64x8<S>; 2] {
        let done = self.done;
        self.done = done & !done;
        [done, done]
    }
}

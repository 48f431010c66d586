//! Several points from the light on one walk.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::walk::{Walk, World};
use super::{Page, Pages, Sums};
use crate::kernels::packet::bank::Numbers;
use crate::single_scattering::technique::{MOST, point};
use crate::space::shadow::Found;
use crate::space::tally::add_where;
use numeric::Lane;
use numeric::pack::WIDTH;

/// Eight walks that pass their points.
pub struct Shared<'a, S: Simd> {
    world: World<'a>,
    walk: Walk<'a, S>,
    done: mask64x8<S>,
    count: usize,
    points: Box<Ahead>,
    /// The next point; infinite behind the last one.
    next: f64x8<S>,
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

/// The points of eight walks, in memory of their own: what an index finds would keep the walks in memory, too.
struct Ahead {
    /// Those of each, ascending; then infinity.
    points: [[f64; MOST + 1]; WIDTH],
    /// The number of the next one.
    next: [usize; WIDTH],
}

impl Ahead {
    /// Each of those that a mask names, as bits, has so many points, in order from now on.
    #[inline(never)]
    fn sort(&mut self, mut which: u64, count: usize) {
        while which != 0 {
            let lane = which.trailing_zeros() as usize % WIDTH;
            which &= which - 1;
            self.points[lane][..count].sort_unstable_by(f64::total_cmp);
            self.points[lane][count] = f64::INFINITY;
            self.next[lane] = 0;
        }
    }

    /// The next points, after those that a mask names, as bits, have passed theirs.
    #[inline(always)]
    fn pass(&mut self, mut which: u64, next: &mut [f64; WIDTH]) {
        while which != 0 {
            let lane = which.trailing_zeros() as usize % WIDTH;
            which &= which - 1;
            let number = (self.next[lane] + 1).min(MOST);
            self.next[lane] = number;
            next[lane] = self.points[lane][number];
        }
    }
}

/// Several points.
#[derive(Clone, Copy)]
pub struct Technique {
    /// How many.
    pub count: usize,
}

impl<'a> Pages<'a> for Technique {
    type Page<S: Simd> = Shared<'a, S>;

    #[inline(always)]
    fn page<S: Simd>(self, simd: S, world: World<'a>, walk: Walk<'a, S>) -> Self::Page<S> {
        let (zero, none) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, false));
        Shared {
            world,
            walk,
            done: none,
            count: self.count,
            points: Box::new(Ahead { points: [[0.0; MOST + 1]; WIDTH], next: [0; WIDTH] }),
            next: zero,
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
    fn begin(&mut self, numbers: &mut Numbers<S>, which: mask64x8<S>, _: &mut Sums<S>) {
        let problem = &*self.world.setup.problem;
        let (bits, mut row) = (which.to_bitmask(), [0.0; WIDTH]);
        for number in 0..self.count {
            point(problem, numbers.uniform_where(which)).store_slice(&mut row);
            for (lane, s) in row.iter().enumerate() {
                if bits >> lane & 1 == 1 {
                    self.points.points[lane][number] = *s;
                }
            }
        }
        self.points.sort(bits, self.count);
        for (lane, s) in row.iter_mut().enumerate() {
            *s = self.points.points[lane][0];
        }
        self.next = Lane::select(which, f64x8::from_slice(self.next.token(), &row), self.next);
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
        let next = self.next;
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
        let (world, s) = (&self.world, self.next);
        let problem = &*world.setup.problem;
        let source = extinction * problem.source(s) / problem.equiangular_density(s);
        let share = one.each(1.0 / self.count as f64);
        let worth = share * self.weight * world.controlled(s) * source;
        self.worth = Lane::select(is_point, worth, self.worth);
        self.s = Lane::select(is_point, s, self.s);
        let mut row = [0.0; WIDTH];
        self.next.store_slice(&mut row);
        self.points.pass(is_point.to_bitmask(), &mut row);
        self.next = f64x8::from_slice(zero.token(), &row);
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
    fn done(&mut self) -> &mut mask64x8<S> {
        &mut self.done
    }
}

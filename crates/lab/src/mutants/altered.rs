//! A walk around a walk: the steps of the inner one, with work before and after them.
//!
//! ```text
//! begin, numbers, fly, collide  a change may alter the state, the collision and the random numbers before the inner step,
//!                               and the state and the result after it
//! all else                      the inner walk's
//! ```
//!
//! [`Renumbered`] random numbers change a decision inside a step. A change without a bug calls the inner steps alone: with
//! it the walk is the control.

use estimators::walks::{GROUPS, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use media::Batches;
use media::sampling::BothWays;
use numeric::Lane;
use numeric::geometry::Point;
use numeric::rng::Random;

/// Changes of the steps of a walk.
pub trait Change<W: Walk>: Copy {
    /// [`Walk::begin`], changed.
    #[inline(always)]
    fn begin<L: Lane>(
        &self,
        walk: &W,
        one: L,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> W::State<L> {
        walk.begin(one, which, random)
    }

    /// [`Walk::numbers`], changed.
    #[inline(always)]
    fn numbers<L: Lane>(
        &self,
        walk: &W,
        state: &mut W::State<L>,
        random: &mut impl Random<L>,
    ) -> [L; 2] {
        walk.numbers(state, random)
    }

    /// [`Walk::fly`], changed.
    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        walk: &W,
        state: &mut W::State<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        walk.fly(state, route, depth)
    }

    /// [`Walk::collide`], changed.
    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        walk: &W,
        state: &mut W::State<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        walk.collide(state, route, extinctions, random)
    }
}

/// A walk with changed steps.
#[derive(Clone, Copy)]
pub struct Altered<W, C> {
    /// The inner walk.
    pub walk: W,
    /// The changes of its steps.
    pub change: C,
}

impl<W: Walk, C: Change<W>> Walk for Altered<W, C> {
    type State<L: Lane> = W::State<L>;

    const DECIDES: bool = W::DECIDES;
    const IS_FIXED: bool = W::IS_FIXED;
    const ON_RAY: bool = W::ON_RAY;
    const IN_SPACE: bool = W::IN_SPACE;
    const PAUSES: bool = W::PAUSES;
    const IS_CHROMATIC: bool = W::IS_CHROMATIC;
    const HAS_DEFECT: bool = W::HAS_DEFECT;
    const IS_NOWHERE: bool = W::IS_NOWHERE;
    const SCORES: Scores = W::SCORES;

    #[inline(always)]
    fn begin<L: Lane>(
        &self,
        one: L,
        which: L::Mask,
        random: &mut impl Random<L>,
    ) -> Self::State<L> {
        self.change.begin(&self.walk, one, which, random)
    }

    #[inline(always)]
    fn numbers<L: Lane>(&self, state: &mut Self::State<L>, random: &mut impl Random<L>) -> [L; 2] {
        self.change.numbers(&self.walk, state, random)
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        self.change.fly(&self.walk, state, route, depth)
    }

    #[inline(always)]
    fn distance<L: Lane>(&self, state: &Self::State<L>, route: &Route<impl BothWays<L>>) -> L {
        self.walk.distance(state, route)
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(
        &self,
        state: &Self::State<L>,
        route: &Route<impl BothWays<L>>,
    ) -> L {
        self.walk.mean_free_path(state, route)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        self.change.collide(&self.walk, state, route, extinctions, random)
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.walk.media()
    }

    #[inline(always)]
    fn in_space<L: Lane>(&self, state: &Self::State<L>) -> (L::Mask, [L; 3]) {
        self.walk.in_space(state)
    }

    #[inline(always)]
    fn fields(&self) -> &[Batches<'_>] {
        self.walk.fields()
    }

    #[inline(always)]
    fn field(&self, number: usize, place: Point) -> f64 {
        self.walk.field(number, place)
    }

    #[inline(always)]
    fn lookups<L: Lane>(&self, state: &Self::State<L>, counted: L) -> L {
        self.walk.lookups(state, counted)
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.walk.channels()
    }

    #[inline(always)]
    fn value<L: Lane>(&self, state: &Self::State<L>, left: L::Mask, channel: usize) -> L {
        self.walk.value(state, left, channel)
    }

    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        state: &'a Self::State<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        self.walk.leaves(state, some)
    }

    #[inline(always)]
    fn scores<L: Lane>(&self, state: &Self::State<L>, ended: L::Mask) -> L::Mask {
        self.walk.scores(state, ended)
    }

    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], left: L::Mask, lookups: L, values: &mut [L]) -> L {
        self.walk.score(numbers, left, lookups, values)
    }

    #[inline(always)]
    fn defect<L: Lane>(&self, state: &Self::State<L>, zero: L) -> L {
        self.walk.defect(state, zero)
    }
}

/// Random numbers of which some uniform ones are changed, given the numbers of them before.
pub struct Renumbered<'a, R, F> {
    random: &'a mut R,
    count: usize,
    change: F,
}

impl<'a, R, F> Renumbered<'a, R, F> {
    /// Changes the numbers of a generator.
    #[inline(always)]
    pub fn new(random: &'a mut R, change: F) -> Self {
        Self { random, count: 0, change }
    }

    #[inline(always)]
    fn changed<L>(&mut self, number: L) -> L
    where
        F: Fn(usize, L) -> L,
    {
        self.count += 1;
        (self.change)(self.count - 1, number)
    }
}

impl<L: Lane, R: Random<L>, F: Fn(usize, L) -> L> Random<L> for Renumbered<'_, R, F> {
    #[inline(always)]
    fn uniform(&mut self) -> L {
        let number = self.random.uniform();
        self.changed(number)
    }

    #[inline(always)]
    fn ln_uniform(&mut self) -> L {
        self.random.ln_uniform()
    }

    #[inline(always)]
    fn uniform_where(&mut self, which: L::Mask) -> L {
        let number = self.random.uniform_where(which);
        self.changed(number)
    }

    #[inline(always)]
    fn ln_uniform_where(&mut self, which: L::Mask) -> L {
        self.random.ln_uniform_where(which)
    }
}

//! Walks from tentative collision to tentative collision, each written once for one lane and for packs of lanes.
//!
//! ```text
//! begin
//! repeat
//!     fly       through an optical depth −ln u of σ̂
//!     look up   σ_t at the tentative collision, unless the walk has left the medium
//!     collide   another random number decides; some walks end
//! value
//! ```
//!
//! A [`Walk`] defines each of these steps, for any [`Lane`]. Three drivers run it. They make the same draws, bit
//! for bit:
//!
//! | driver | walks side by side | for |
//! |---|--:|---|
//! | [`plain`] | 1 | every walk |
//! | [`window`] | 16 | walks whose steps all take the same random numbers: no step has a branch |
//! | [`bank`] | 16 | all other walks |
//!
//! Packs take most of the time in which this crate is compiled. A family of walks has them on two conditions. They draw at
//! least twice as fast as one lane. And its draws are 1 % of the built-in suite or of pictures, or its packs are compiled in
//! 2 s. AVX-512 is there beside AVX2 if it is at least 1.2 times as fast. `trueflight bench --level` measures both; so far
//! all families have both. Constants of a [`Walk`] say for which courses and fields packs are compiled.
//!
//! Fields are looked up along the ray, in space, or in both places: a shadow ray leaves the ray of the camera.
//! Expensive events may wait. A walk stores the lanes that need one, and handles it when
//! [`are_enough`](numeric::Mask::are_enough) of a pack do; the other lanes go on. A walk may be scored at its end or
//! later, see [`Scores`]. A walk in several channels flies through the σ̂ of one of them, its [`hero`].
//!
//! Source: F. B. Brown, W. R. Martin, *Monte Carlo methods for radiation transport analysis on vector
//! computers*, Progress in Nuclear Energy 14 (1984), for [`window`] and [`bank`].

pub mod bank;
pub mod draws;
pub mod hero;
mod outcomes;
pub mod plain;
mod route;
pub mod slots;
pub mod steps;
pub mod window;

use media::Batches;
use media::sampling::BothWays;
use numeric::geometry::Point;
use numeric::rng::Random;
use numeric::{Kept, Lane};

pub(crate) use draws::drawn;
pub use draws::{by, fill, in_turn, one_by_one, packets, packets_in_space};
pub use plain::draw;
pub use route::{Nowhere, Route};

/// A walk along a line, as one formula for every lane type.
pub trait Walk: Copy {
    /// The state of a walk, beside its position.
    type State<L: Lane>: Kept<L::Mask>;

    /// True if a step takes a second random number, which decides the event at the collision.
    const DECIDES: bool = true;

    /// True if a step takes no further random numbers, a draw has one channel, and its value and defect are known
    /// before [`Walk::collide`], which may overwrite the state of walks that end: the walk runs in a [`window`].
    const IS_FIXED: bool = false;

    /// True if fields are looked up at distances along the ray, see [`Walk::distance`].
    const ON_RAY: bool = true;

    /// True if fields are looked up at places in space, see [`Walk::in_space`].
    const IN_SPACE: bool = false;

    /// True if a walk may go on after a step without a lookup, as shadow rays do that leave the medium. Walks with
    /// lookups in space always may.
    const PAUSES: bool = Self::IN_SPACE;

    /// True if each walk flies through the σ̂ of its own channel, each of one value, and σ_t of [`Walk::media`]
    /// channels is looked up.
    const IS_CHROMATIC: bool = false;

    /// True if packs fly through a σ̂ of several values, too; else one walk after the other does.
    const IN_PIECES: bool = true;

    /// True if [`Walk::defect`] may exceed 0.
    const HAS_DEFECT: bool = false;

    /// True if [`Walk::value`] depends only on whether the walk has left the medium, and [`Walk::defect`] is nearly
    /// always 0: the steps of a [`window`] store neither.
    const IS_SURVIVAL: bool = false;

    /// True if the walk keeps its own position and needs no route.
    const IS_NOWHERE: bool = false;

    /// Time at which finished walks are scored.
    const SCORES: Scores = Scores::AtOnce;

    /// True if the formula of Eq. 21 is compiled into the loop of packs, see [`media::Inlined`].
    const INLINES_EQ21: bool = false;

    /// True if the formula of voxel grids is compiled into the loop of packs, see [`media::Inlined`].
    const INLINES_GRID: bool = false;

    /// The state at the beginning. Only lanes in `which` may take random numbers; `one` is 1 in every lane.
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>)
    -> Self::State<L>;

    /// Replaces the walks that have ended, those of the lanes in `which`. A walk that overwrites parts of its state before
    /// it reads them need not reset these.
    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        which: L::Mask,
        one: L,
        random: &mut impl Random<L>,
    ) {
        state.set_where(which, self.begin(one, which, random));
    }

    /// The random numbers of a step: the optical depth of its flights, and the number that decides.
    #[inline(always)]
    fn numbers<L: Lane>(&self, state: &mut Self::State<L>, random: &mut impl Random<L>) -> [L; 2] {
        let _ = state;
        let depth = -random.ln_uniform();
        [depth, if Self::DECIDES { random.uniform() } else { depth }]
    }

    /// Flies through an optical depth; returns the lanes that come to a tentative collision.
    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        let _ = state;
        route.here.fly(depth)
    }

    /// The distance of the tentative collision.
    #[inline(always)]
    fn distance<L: Lane>(&self, state: &Self::State<L>, route: &Route<impl BothWays<L>>) -> L {
        let _ = state;
        route.here.reached()
    }

    /// `1/σ̂` there.
    #[inline(always)]
    fn mean_free_path<L: Lane>(
        &self,
        state: &Self::State<L>,
        route: &Route<impl BothWays<L>>,
    ) -> L {
        let _ = state;
        route.here.mean_free_path()
    }

    /// Handles the collision, or that the medium was left; returns the lanes that go on.
    fn collide<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        route: &mut Route<impl BothWays<L>>,
        collided: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask;

    /// Number of fields that are looked up at a place: σ_t of each channel, in space perhaps the albedo.
    #[inline(always)]
    fn media(&self) -> usize {
        1
    }

    /// Lanes at a tentative collision in space, and the places of all lanes there.
    #[inline(always)]
    fn in_space<L: Lane>(&self, state: &Self::State<L>) -> (L::Mask, [L; 3]) {
        let _ = state;
        unreachable!("the walk has no lookups in space")
    }

    /// The fields in space as packs look them up; at most two, if the walk is not [`Walk::IS_CHROMATIC`].
    #[inline(always)]
    fn fields(&self) -> &[Batches<'_>] {
        &[]
    }

    /// The value of a field in space at a place.
    #[inline(always)]
    fn field(&self, number: usize, place: Point) -> f64 {
        let _ = (number, place);
        0.0
    }

    /// The number of lookups of walks that pause, given those that the driver counted.
    #[inline(always)]
    fn lookups<L: Lane>(&self, state: &Self::State<L>, counted: L) -> L {
        let _ = state;
        counted
    }

    /// The number of channels of a draw.
    #[inline(always)]
    fn channels(&self) -> usize {
        1
    }

    /// The value of walks that have ended, in one channel. Lanes in `left` have left the medium; the others ended
    /// at a collision. Called if walks are scored [`Scores::AtOnce`].
    #[inline(always)]
    fn value<L: Lane>(&self, state: &Self::State<L>, left: L::Mask, channel: usize) -> L {
        let _ = (state, left, channel);
        unreachable!("the walk is scored later")
    }

    /// The numbers that walks leave for [`Walk::score`], at most [`MAX_OUTCOME`] altogether: lists of the state, and
    /// numbers that are copied to `some`, so that the originals stay in registers.
    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        state: &'a Self::State<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        let _ = (state, some);
        [&[]; GROUPS]
    }

    /// Lanes that leave numbers in this step, where walks are scored [`Scores::Often`].
    #[inline(always)]
    fn scores<L: Lane>(&self, state: &Self::State<L>, ended: L::Mask) -> L::Mask {
        let _ = state;
        ended
    }

    /// Computes values from the numbers that walks left, and from their lookups; returns the defect. Lanes in
    /// `left` had left the medium, if walks are scored [`Scores::Later`].
    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], left: L::Mask, lookups: L, values: &mut [L]) -> L {
        let _ = (numbers, left, values);
        lookups.each(0.0)
    }

    /// See [`crate::Draw::defect`].
    #[inline(always)]
    fn defect<L: Lane>(&self, state: &Self::State<L>, zero: L) -> L {
        let _ = state;
        zero
    }
}

/// Times at which walks are scored.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Scores {
    /// At the end of each walk.
    AtOnce,
    /// After the end of walks, eight draws at a time, from numbers that they leave: few walks end in the same step.
    Later,
    /// At any step, eight scores at a time, from numbers that walks leave. A draw is their sum.
    Often,
}

/// Number of lists of numbers that a walk leaves.
pub const GROUPS: usize = 5;
/// Maximum number of these numbers that are copied.
pub const SOME_LEFT: usize = 5;
/// Maximum number of numbers of an outcome.
pub const MAX_OUTCOME: usize = 40;
/// Maximum number of values of a draw that is not scored at once.
pub const MAX_SCORED: usize = 16;

/// A tentative collision. Lanes without one have arbitrary numbers.
#[derive(Clone, Copy)]
pub struct TentativeCollision<'a, L: Lane> {
    /// Lanes at a tentative collision.
    pub inside: L::Mask,
    /// The distance.
    pub t: L,
    /// `1/σ̂`.
    pub mean_free_path: L,
    /// `σ_t`, unless the walk [`Walk::IS_CHROMATIC`].
    pub extinction: L,
    /// `σ_t` of each channel, if it is.
    pub extinctions: &'a [L],
    /// Fields at the places of [`Walk::in_space`].
    pub in_space: &'a [L],
    /// Uniform in `[0, 1)`, if the walk [`Walk::DECIDES`].
    pub number: L,
}

impl<L: Lane> TentativeCollision<'_, L> {
    /// `r = σ_t/σ̂`.
    #[inline(always)]
    pub fn ratio(&self) -> L {
        self.extinction * self.mean_free_path
    }
}

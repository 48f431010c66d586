//! The walk along the whole ray for several points from the light.
//!
//! ```text
//! begin    points sⱼ;  T̂ = 1
//! fly      through σ̂ to the next interaction point, or less far, to the next sⱼ
//! collide  at a point         a shadow ray is cast, and the walk waits;  T̂ T_c σ_t S T̂_shadow/(n p) is added
//!          at an interaction  T̂ ← T̂ (1 − r)
//! ```

use super::ray_setup::RaySetup;
use super::shadow::{ToLight, scored_by_shadow_rays};
use crate::walks::{Route, TentativeCollision, Walk};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};

/// The maximum number of points on one walk.
pub const MAX_POINTS: usize = 16;

kept! {
    /// Walks past their points.
    pub struct Path<L> {
        /// Lanes that begin in the next step.
        begins: L::Mask,
        walks: L::Mask,
        /// Lanes among them that are not on a shadow ray.
        active: L::Mask,
        /// Lanes with a flight that has not reached its end.
        pending: L::Mask,
        /// Lanes at a point, and lanes at an interaction point.
        is_point: L::Mask,
        is_interaction: L::Mask,
        /// The end of the flight; infinite beyond the ray.
        reached: L,
        points: [L; MAX_POINTS],
        /// The next point, infinite after the last one, and its number.
        next: L,
        number: L,
        weight: L,
        s: L,
        worth: L,
        score: L,
        to_light: ToLight<L>,
    }
}

/// The walk past a number of points.
#[derive(Clone, Copy)]
pub struct Shared<'a> {
    /// The ground.
    pub ground: RaySetup<'a>,
    /// n.
    pub points: usize,
}

impl Shared<'_> {
    /// Begins draws.
    #[inline(always)]
    fn start<L: Lane>(&self, path: &mut Path<L>, random: &mut impl Random<L>) {
        let (begins, zero) = (path.begins, path.s.each(0.0));
        for point in path.points.iter_mut().take(self.points) {
            let number = random.uniform_where(begins);
            let chosen = self.ground.from_light(number);
            *point = L::select(begins, chosen, *point).sealed();
        }
        path.next.set_where(begins, zero.each(f64::NEG_INFINITY));
        path.number.set_where(begins, zero.each(-1.0));
        self.pass(path, begins);
        path.walks |= begins;
        path.weight.set_where(begins, zero.each(1.0));
        path.score.set_where(begins, zero);
        path.begins &= !begins;
    }

    /// Finds the point after the next one; of equal points, the one with the next number.
    #[inline(always)]
    fn pass<L: Lane>(&self, path: &mut Path<L>, which: L::Mask) {
        let (mut next, mut number) = (path.next.each(f64::INFINITY), path.number);
        for (candidate, &point) in path.points.iter().enumerate().take(self.points) {
            let candidate = number.each(candidate as f64);
            let is_equal = path.next.at_most(point) & path.number.below(candidate);
            let is_next = (path.next.below(point) | is_equal) & point.below(next);
            next.set_where(is_next, point);
            number.set_where(is_next, candidate);
        }
        path.next.set_where(which, next);
        path.number.set_where(which, number);
    }
}

impl Walk for Shared<'_> {
    type State<L: Lane> = Path<L>;

    const IN_SPACE: bool = true;
    const IN_PIECES: bool = false;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, all: L::Mask, _: &mut impl Random<L>) -> Path<L> {
        let (zero, none) = (one.each(0.0), !all);
        Path {
            begins: all,
            walks: none,
            active: none,
            pending: none,
            is_point: none,
            is_interaction: none,
            reached: zero,
            points: [zero; MAX_POINTS],
            next: zero,
            number: zero,
            weight: one,
            s: one.each(self.ground.support.from),
            worth: zero,
            score: zero,
            to_light: ToLight::none(zero),
        }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, _: L, _: &mut impl Random<L>) {
        path.begins |= which;
    }

    #[inline(always)]
    fn numbers<L: Lane>(&self, path: &mut Path<L>, random: &mut impl Random<L>) -> [L; 2] {
        // Called in one place only: its code is long.
        if path.begins.any() {
            self.start(path, random);
        }
        path.active = path.walks & !path.to_light.step();
        [path.to_light.depth(path.active & !path.pending, random); 2]
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        path.to_light.fly(&self.ground, depth);
        let (flies, endless) = (path.active & !path.pending, depth.each(f64::INFINITY));
        if flies.maybe() {
            let inside = route.here.fly(L::select(flies, depth, depth.each(0.0)));
            path.reached.set_where(flies, L::select(inside, route.here.reached(), endless));
        }
        path.pending |= flies;
        let is_ahead = path.next.below(endless) & path.next.at_most(path.reached);
        path.is_point = path.active & is_ahead;
        path.is_interaction = path.active & !is_ahead & path.reached.below(endless);
        path.is_point | path.is_interaction
    }

    #[inline(always)]
    fn distance<L: Lane>(&self, path: &Path<L>, _: &Route<impl BothWays<L>>) -> L {
        L::select(path.is_point, path.next, path.reached)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { t, extinction, .. }, problem) =
            (*extinctions, &*self.ground.setup.problem);
        let Path { is_point, is_interaction, .. } = *path;
        let mut aims = is_point;
        if is_point.any() {
            let source = extinction * problem.source(t) / problem.equiangular_density(t);
            let share = path.weight * (1.0 / self.points as f64);
            path.worth.set_where(is_point, share * self.ground.controlled(t) * source);
            path.s.set_where(is_point, t);
            self.pass(path, is_point);
            aims = is_point & t.each(0.0).below(extinction);
        }
        if is_interaction.maybe() {
            path.weight.scale_where(is_interaction, self.ground.kept(&route.here, t, extinction));
        }
        let ends = path.active & !is_point & !is_interaction;
        path.pending &= !(is_interaction | ends);
        path.walks &= !ends;
        let at = (aims, path.s);
        let (lit, light) = path.to_light.collide(&self.ground, extinctions, at, 1, random);
        if lit.any() {
            path.score.add_where(lit, path.worth * light);
        }
        !ends
    }

    scored_by_shadow_rays!();
}

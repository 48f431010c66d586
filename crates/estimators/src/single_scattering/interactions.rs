//! The walk through the whole ray with a scattering point at each interaction point, or at one of them.
//!
//! ```text
//! begin    T̂ = 1
//! fly      through σ̂ to the next interaction point
//! collide  y = T̂ T_c σ_t S/σ̂;  T̂ ← T̂ (1 − r)
//!            each   a shadow ray is cast, and the walk waits;  the draw is Σ y T̂_shadow
//!            one    Σ|y| grows, and the point is kept with probability |y|/Σ|y|
//! leave    one: a shadow ray is cast from the point that was kept;  the draw is ±Σ|y| T̂_shadow
//! ```

use super::ray_setup::RaySetup;
use super::shadow::{ToLight, scored_by_shadow_rays};
use crate::walks::{Route, TentativeCollision, Walk};
use media::sampling::{BothWays, PackedFlight};
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};

kept! {
    /// Walks along the ray.
    pub struct Path<L> {
        walks: L::Mask,
        flies: L::Mask,
        /// T̂.
        weight: L,
        /// The point of the shadow ray, or the point that is kept.
        s: L,
        /// y.
        worth: L,
        /// `Σ|y|`.
        sum: L,
        score: L,
        to_light: ToLight<L>,
    }
}

/// The walk, with a shadow ray from each point, or `RESAMPLED` from one of them.
#[derive(Clone, Copy)]
pub struct Interactions<'a, const RESAMPLED: bool> {
    /// The ground.
    pub ground: RaySetup<'a>,
}

impl<const RESAMPLED: bool> Walk for Interactions<'_, RESAMPLED> {
    type State<L: Lane> = Path<L>;

    const IN_SPACE: bool = true;
    const IN_PIECES: bool = false;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Path<L> {
        let (zero, all, s) = (one.each(0.0), one.at_most(one), one.each(self.ground.support.from));
        let to_light = ToLight::none(zero);
        Path {
            walks: all,
            flies: all,
            weight: one,
            s,
            worth: zero,
            sum: zero,
            score: zero,
            to_light,
        }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, one: L, _: &mut impl Random<L>) {
        path.walks |= which;
        path.weight.set_where(which, one);
        path.sum.set_where(which, one.each(0.0));
        path.score.set_where(which, one.each(0.0));
    }

    #[inline(always)]
    fn numbers<L: Lane>(&self, path: &mut Path<L>, random: &mut impl Random<L>) -> [L; 2] {
        path.flies = path.walks & !path.to_light.step();
        [path.to_light.depth(path.flies, random); 2]
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        path.to_light.fly(&self.ground, depth);
        path.flies & route.here.fly(L::select(path.flies, depth, depth.each(0.0)))
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, extinction, .. }, zero) =
            (*extinctions, extinctions.t.each(0.0));
        let left = path.flies & !inside;
        path.walks &= !left;
        let (mut aims, mut ends) = (left & !left, left);
        if inside.maybe() {
            aims = self.choose(path, &route.here, extinctions, random);
            let kept = self.ground.kept(&route.here, t, extinction);
            path.weight.scale_where(inside, kept);
        }
        if RESAMPLED {
            ends = left & path.sum.at_most(zero);
            aims = left & !ends;
        }
        let at = (aims, path.s);
        let (lit, light) = path.to_light.collide(&self.ground, extinctions, at, 1, random);
        if lit.any() && RESAMPLED {
            // The draw is the score of its only point, its sign included where it is 0.
            path.score.set_where(lit, path.sum.with_sign_of(path.worth) * light);
            ends |= lit;
        } else if lit.any() {
            path.score.add_where(lit, path.worth * light);
        }
        !ends
    }

    scored_by_shadow_rays!();
}

impl<const RESAMPLED: bool> Interactions<'_, RESAMPLED> {
    /// Keeps interaction points; answers which lanes did.
    #[inline(always)]
    fn choose<L: Lane>(
        &self,
        path: &mut Path<L>,
        here: &impl PackedFlight<L>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let TentativeCollision { inside, t, extinction, .. } = *extinctions;
        let source = extinction * self.ground.setup.problem.source(t) / here.sampling();
        let worth = path.weight * self.ground.controlled(t) * source;
        let mut chosen = inside & t.each(0.0).below(extinction);
        if RESAMPLED {
            path.sum.add_where(chosen, worth.size());
            let number = random.uniform_where(chosen);
            chosen &= (number * path.sum).below(worth.size());
        }
        path.s.set_where(chosen, t);
        path.worth.set_where(chosen, worth);
        chosen
    }
}

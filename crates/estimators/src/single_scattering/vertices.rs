//! The walk to scattering points that are chosen one after the other: points from the light, points from the main part of the
//! control, and first real collisions.
//!
//! ```text
//! begin    a point s, or none where a collision comes first
//! fly      through σ̂ to the point, or to the next tentative collision
//! collide  at the point      σ_t = 0: the next one
//!          on the way there  exact: at once;  ratio  T̂ ← T̂ (1 − r);  delta  the end with probability σ_t/σ̂
//!          no point          null  x ← x (1 − r);  scattered: s;  absorbed: the next one
//!          a shadow ray is cast from s; the draw is the sum of what the points score
//! ```
//!
//! | points | score |
//! |---|---|
//! | chosen | `T̂ σ_t S T̂_shadow/p`, p the sum of the densities of both kinds |
//! | collisions | `S/c T̂_shadow` |
//! | both | `q S/c T̂_shadow/(p_i/w_i)`, `q = c σ_t x` |

use super::main_part::MainPart;
use super::points::{Absorption, Vertices};
use super::ray_setup::RaySetup;
use super::shadow::{TOGETHER, ToLight, scored_by_shadow_rays};
use crate::walks::{Route, TentativeCollision, Walk};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};
use theory::single::CameraTracking;

/// A scattering point that has found light.
#[derive(Clone, Copy)]
pub struct Vertex<L: Lane> {
    /// The distance.
    pub s: L,
    /// `σ_t` there.
    pub extinction: L,
    /// The transmittance from the ray's origin, or x.
    pub kept: L,
    /// Lanes with a chosen point; the others collided there.
    pub is_chosen: L::Mask,
    /// The transmittance of the shadow ray.
    pub light: L,
}

kept! {
    /// Walks to their points.
    pub struct Path<L> {
        /// Lanes that begin a point in the next step.
        pub begins: L::Mask,
        /// Lanes that set out from the ray's origin in the next step.
        pub sets_out: L::Mask,
        /// Lanes at a point where σ_t is not known yet.
        looks: L::Mask,
        walks: L::Mask,
        /// Lanes on their way along the ray that fly in this step.
        pub flies: L::Mask,
        /// Lanes with a chosen point.
        pub is_chosen: L::Mask,
        /// Lanes at the second of two chosen points.
        is_second: L::Mask,
        /// Lanes that have yet to begin their next point or draw.
        done: L::Mask,
        /// The distance of the point.
        pub s: L,
        extinction: L,
        kept: L,
        /// The score so far.
        pub score: L,
        /// The number of lookups that needed no step.
        known: L,
        /// The shadow ray.
        pub to_light: ToLight<L>,
    }
}

/// The walk, by points that are `CHOSEN`, by collisions where it `COLLIDES`, or by both.
#[derive(Clone, Copy)]
pub struct ToVertices<'a, const CHOSEN: bool, const COLLIDES: bool> {
    ground: RaySetup<'a>,
    plan: Vertices,
    main: Option<MainPart<'a>>,
    /// c, the probability that a real collision scatters.
    scatters: f64,
}

impl<'a, const CHOSEN: bool, const COLLIDES: bool> ToVertices<'a, CHOSEN, COLLIDES> {
    /// The number of lanes of a pack that score together, and the number that begin together. Lanes stand still
    /// until then: at least one of eight must go on.
    const SCORES: u32 = if CHOSEN { 4 } else { 1 };
    const BEGIN: u32 = if CHOSEN { 2 } else { 1 };

    /// The walk on a ground.
    #[inline(always)]
    pub fn new(ground: RaySetup<'a>, plan: Vertices) -> Self {
        const { assert!(TOGETHER + Self::SCORES + Self::BEGIN < 8 + 3, "all lanes may wait") };
        let absorption = plan.collision.unwrap_or(Absorption::Weight);
        let scatters = absorption.scatters(ground.setup.problem.albedo());
        let main = if plan.main { MainPart::of(ground.setup) } else { None };
        Self { ground, plan, main, scatters }
    }

    #[inline(always)]
    fn is_tracked(&self) -> bool {
        self.plan.camera != CameraTracking::Exact
    }

    #[inline(always)]
    fn has_two_points(&self) -> bool {
        !COLLIDES && self.plan.light && self.main.is_some()
    }

    #[inline(always)]
    fn chosen<L: Lane>(path: &Path<L>) -> L::Mask {
        match (CHOSEN, COLLIDES) {
            (true, true) => path.is_chosen,
            (true, false) => path.looks | !path.looks,
            _ => path.looks & !path.looks,
        }
    }

    /// Begins the next point of the lanes in `which`.
    #[inline(always)]
    fn start<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, random: &mut impl Random<L>) {
        let mut looks = which;
        if !CHOSEN {
            path.sets_out |= which;
            return;
        }
        if COLLIDES && self.plan.is_one {
            let number = random.uniform_where(which);
            looks &= number.below(number.each(0.5));
            Self::seek(path, which & !looks);
        }
        let number = random.uniform_where(looks);
        let s = match (&self.main, self.plan.light) {
            (Some(main), false) => main.outlined_point(number),
            (Some(main), true) => {
                let from_light = self.ground.from_light(number);
                L::select(path.is_second, main.outlined_point(number), from_light)
            }
            (None, _) => self.ground.from_light(number),
        };
        path.s.set_where(looks, s);
        path.is_chosen |= looks;
        match self.ground.extinction {
            // σ_t is known without a step.
            Some(value) if value > 0.0 && self.is_tracked() => {
                path.known.count_where(looks);
                path.extinction.set_where(looks, s.each(value));
                path.sets_out |= looks;
            }
            _ => path.looks |= looks,
        }
    }

    /// Lanes in `which` go on to their first real collision.
    #[inline(always)]
    fn seek<L: Lane>(path: &mut Path<L>, which: L::Mask) {
        path.is_chosen &= !which;
        path.sets_out |= which;
    }

    /// Lanes set out from the ray's origin.
    #[inline(always)]
    fn set_out<L: Lane>(&self, path: &mut Path<L>) {
        path.walks |= path.sets_out;
        if CHOSEN && self.plan.camera == CameraTracking::Ratio {
            path.kept.set_where(path.sets_out, self.ground.controlled(path.s));
        } else if CHOSEN {
            path.kept.set_where(path.sets_out, path.s.each(1.0));
        }
    }

    /// Handles collisions without a point; returns the lanes that scatter, and those that have come to their end.
    #[inline(always)]
    fn track<L: Lane>(
        &self,
        path: &mut Path<L>,
        here: &impl BothWays<L>,
        extinctions: &TentativeCollision<L>,
        inside: L::Mask,
    ) -> [L::Mask; 2] {
        let TentativeCollision { t, number, extinction, .. } = *extinctions;
        let (chosen, left) = (Self::chosen(path), path.flies & !inside);
        let threshold = number * here.sampling();
        let real = inside & !chosen & threshold.below(extinction);
        let hits = real & threshold.below(extinction * self.scatters);
        if CHOSEN && self.is_tracked() {
            let kept = self.ground.kept(here, t, extinction);
            path.kept.scale_where(inside & !real, kept);
        }
        path.walks &= !(real | left);
        path.s.set_where(hits, t);
        path.extinction.set_where(hits, extinction);
        [hits | (left & chosen), (real & !hits) | (left & !chosen)]
    }

    /// Handles collisions on the way to points; returns the lanes that arrive, and those that end.
    #[inline(always)]
    fn approach<L: Lane>(
        &self,
        path: &mut Path<L>,
        here: &impl BothWays<L>,
        extinctions: &TentativeCollision<L>,
        inside: L::Mask,
        random: &mut impl Random<L>,
    ) -> [L::Mask; 2] {
        let TentativeCollision { t, extinction, .. } = *extinctions;
        let arrives = path.flies & !inside;
        let mut ends = inside & !inside;
        if self.plan.camera == CameraTracking::Delta {
            let number = random.uniform_where(inside);
            ends = inside & (number * here.sampling()).below(extinction);
        } else {
            path.kept.scale_where(inside, self.ground.kept(here, t, extinction));
        }
        path.walks &= !(arrives | ends);
        [arrives, ends]
    }

    /// Scores the vertices of the lanes in `which`.
    #[inline(always)]
    fn score<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, light: L) {
        let score = self.value(self.vertex(path, which, light));
        // The draw is the score of its only point, its sign included where it is 0.
        let is_only = CHOSEN && !COLLIDES && !self.has_two_points();
        path.score.set_where(which, if is_only { score } else { path.score + score });
    }

    /// The vertices of the lanes in `which`, with the transmittances of their shadow rays.
    #[inline(always)]
    pub fn vertex<L: Lane>(&self, path: &Path<L>, which: L::Mask, light: L) -> Vertex<L> {
        let Path { s, extinction, mut kept, .. } = *path;
        if CHOSEN && !self.is_tracked() {
            kept = self.ground.transmittance(s, which);
        }
        Vertex { s, extinction, kept, is_chosen: Self::chosen(path), light }
    }

    /// The score of a vertex.
    #[inline(always)]
    pub fn value<L: Lane>(&self, vertex: Vertex<L>) -> L {
        let (Vertex { s, extinction, kept, is_chosen, light }, plan) = (vertex, &self.plan);
        let problem = &*self.ground.setup.problem;
        if !COLLIDES {
            let density = match (&self.main, plan.light) {
                (None, _) => problem.equiangular_density(s),
                (Some(main), false) => main.outlined_density(s),
                (Some(main), true) => problem.equiangular_density(s) + main.outlined_density(s),
            };
            return kept * (extinction * problem.source(s)) * light / density;
        }
        let source = problem.source(s) / s.each(self.scatters);
        if !CHOSEN {
            return source * light;
        }
        let collision = extinction * self.scatters * kept;
        let point = problem.equiangular_density(s);
        let own = L::select(is_chosen, point, collision);
        let other = L::select(is_chosen, collision, point);
        let density = plan.heuristic.shared(own, other);
        collision * source * light / density * if plan.is_one { 2.0 } else { 1.0 }
    }
}

impl<const CHOSEN: bool, const COLLIDES: bool> Walk for ToVertices<'_, CHOSEN, COLLIDES> {
    type State<L: Lane> = Path<L>;

    const IN_SPACE: bool = true;
    const IN_PIECES: bool = false;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, all: L::Mask, _: &mut impl Random<L>) -> Path<L> {
        let (zero, none, s) = (one.each(0.0), !all, one.each(self.ground.support.from));
        Path {
            begins: all,
            sets_out: none,
            looks: none,
            walks: none,
            flies: none,
            is_chosen: none,
            is_second: none,
            done: none,
            s,
            extinction: zero,
            kept: one,
            score: zero,
            known: zero,
            to_light: ToLight::none(zero),
        }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, one: L, _: &mut impl Random<L>) {
        path.begins |= which;
        path.score.set_where(which, one.each(0.0));
        path.known.set_where(which, one.each(0.0));
    }

    #[inline(always)]
    fn numbers<L: Lane>(&self, path: &mut Path<L>, random: &mut impl Random<L>) -> [L; 2] {
        // Called in one place only: its code is long.
        if path.begins.any() {
            self.start(path, path.begins, random);
            path.begins &= !path.begins;
        }
        if path.sets_out.any() {
            self.set_out(path);
        }
        path.flies = path.walks & !path.to_light.step();
        let depth = path.to_light.depth(path.flies, random);
        let decides = path.flies & !Self::chosen(path);
        [depth, if COLLIDES { random.uniform_where(decides) } else { depth }]
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        path.to_light.fly(&self.ground, depth);
        route.here.restart(path.sets_out);
        path.sets_out &= !path.sets_out;
        let mut inside = path.flies;
        if (COLLIDES || self.is_tracked()) && path.flies.maybe() {
            inside &= route.here.fly(L::select(path.flies, depth, depth.each(0.0)));
            if CHOSEN {
                inside &= !Self::chosen(path) | route.here.reached().below(path.s);
            }
        }
        inside | path.looks
    }

    #[inline(always)]
    fn distance<L: Lane>(&self, path: &Path<L>, route: &Route<impl BothWays<L>>) -> L {
        if !CHOSEN {
            return route.here.reached();
        }
        L::select(path.looks, path.s, route.here.reached())
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let looked = path.looks;
        let (none, inside) = (looked & !looked, extinctions.inside & !looked);
        let [mut arrives, mut ends] = if COLLIDES {
            self.track(path, &route.here, extinctions, inside)
        } else if self.is_tracked() {
            self.approach(path, &route.here, extinctions, inside, random)
        } else {
            [none; 2]
        };
        let mut result = none;
        if CHOSEN && looked.any() {
            let extinction = extinctions.extinction;
            let scatters = looked & extinction.each(0.0).below(extinction);
            path.extinction.set_where(looked, extinction);
            path.looks = none;
            result = looked & !scatters;
            if self.is_tracked() {
                path.sets_out |= scatters;
            } else {
                arrives |= scatters;
            }
        }
        let at = (arrives, path.s);
        let (lit, light) =
            path.to_light.collide(&self.ground, extinctions, at, Self::SCORES, random);
        if lit.any() {
            self.score(path, lit, light);
            result |= lit;
        }
        if CHOSEN && COLLIDES && !self.plan.is_one {
            let first = result & path.is_chosen;
            Self::seek(path, first);
            result &= !first;
        }
        ends |= result;
        path.done |= ends;
        if !path.done.are_enough(Self::BEGIN) {
            return !none;
        }
        let mut over = path.done;
        path.done = none;
        if self.has_two_points() {
            let again = over & !path.is_second;
            path.is_second ^= over;
            over &= !again;
            path.begins |= again;
        }
        !over
    }

    #[inline(always)]
    fn lookups<L: Lane>(&self, path: &Path<L>, counted: L) -> L {
        counted + path.known
    }

    scored_by_shadow_rays!();
}

//! The walk from the camera to the emitter, by delta tracking, with a shadow ray from every scattering.
//!
//! ```text
//! begin    at the front, forward
//! fly      forward or backward through σ̂; a shadow ray forward
//! collide  r = σ_t/σ̂
//!   a walk        null, 1 − r       ρ ← ρ (1 − r), where null collisions are part of ρ
//!                 scattered, a r    p = p(ω) towards the emitter;  ρ ← p;  a shadow ray is cast, then the walk goes on
//!                 absorbed          the end
//!                 beyond the end    the weight of a hit is added, 1 if it was never scattered
//!   a shadow ray  t̂ ← t̂ (1 − r), or ended with probability r
//!                 beyond the end    its score p t̂ w is added;  the walk goes on
//! ```
//!
//! ρ is `p_uni/p_nee` of the segment in flight, see [`theory::light::techniques`]; every real scattering
//! resets it. Every flight takes two random numbers, a scattering one more.

use super::shadow::{MediumToLight, ShadowRays};
use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Kernel, Request, Setup};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};
use theory::ParticleRule;
use theory::light::{Shadow, Techniques};
use theory::problems::{LitRod, Problem, Rod};

kept! {
    /// A walk in flight, or paused for its shadow ray.
    pub struct Path<L> {
        /// Lanes that fly forward.
        pub is_forward: L::Mask,
        /// Lanes that were never scattered.
        pub unscattered: L::Mask,
        /// ρ.
        pub ratio: L,
        /// The score so far.
        pub score: L,
        /// The shadow ray.
        pub shadow: ShadowRays<L>,
    }
}

/// The scattering properties at positions of walks.
pub trait Scatterers<L: Lane> {
    /// a.
    fn albedo(&self, t: L) -> L;

    /// `p_f`.
    fn forward(&self, t: L) -> L;
}

impl<L: Lane> Scatterers<L> for &Rod {
    #[inline(always)]
    fn albedo(&self, t: L) -> L {
        self.albedo.value(t)
    }

    #[inline(always)]
    fn forward(&self, t: L) -> L {
        self.forward.value(t)
    }
}

/// The walk to an emitter at the end of a rod.
#[derive(Clone, Copy)]
pub struct ToEmitter<'a> {
    /// The rod.
    pub rod: &'a Rod,
    before: MediumToLight<'a>,
    techniques: Techniques,
}

impl<'a> ToEmitter<'a> {
    /// The walk through a rod to the emitter at `end`.
    #[inline(always)]
    pub fn new(rod: &'a Rod, end: f64, techniques: Techniques) -> Self {
        Self { rod, before: MediumToLight { medium: rod.medium(), end }, techniques }
    }

    /// The walk on a setup.
    #[inline(always)]
    pub fn of(setup: &'a Setup<LitRod>, techniques: Techniques) -> Self {
        Self::new(&setup.problem.rod, setup.fields.mesh.support().to, techniques)
    }
}

/// Makes the draws of a request.
pub fn fill(techniques: Techniques, kernel: Kernel, setup: &Setup<LitRod>, request: Request) {
    walks::fill(&ToEmitter::of(setup, techniques), kernel, setup, request);
}

impl Walk for ToEmitter<'_> {
    type State<L: Lane> = Path<L>;

    const PAUSES: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Path<L> {
        let (all, shadow) = (one.at_most(one), ShadowRays::none(one));
        Path { is_forward: all, unscattered: all, ratio: one, score: one.each(0.0), shadow }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, one: L, _: &mut impl Random<L>) {
        // A scattering sets all other fields.
        path.is_forward |= which;
        path.unscattered |= which;
        path.score.set_where(which, one.each(0.0));
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        route.here.fly_either_way(depth, path.is_forward | path.shadow.casts)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        self.collide_among(&self.rod, path, route, extinctions, random)
    }

    #[inline(always)]
    fn value<L: Lane>(&self, path: &Path<L>, _: L::Mask, _: usize) -> L {
        path.score
    }
}

impl ToEmitter<'_> {
    /// Handles walks and shadow rays among scatterers, as [`Walk::collide`].
    #[inline(always)]
    pub fn collide_among<L: Lane>(
        &self,
        among: &impl Scatterers<L>,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (rays, walks) = (path.shadow.casts, !path.shadow.casts);
        let (mut goes_on, albedo) = (rays, among.albedo(extinctions.t));
        if rays.maybe() {
            path.shadow.track(self.techniques, route, extinctions, &mut path.score);
        }
        if walks.maybe() {
            goes_on |= self.step(among, path, route, (extinctions, albedo), walks, random);
        }
        goes_on
    }

    /// Handles walks at a collision or behind the medium; returns the lanes that go on.
    #[inline(always)]
    fn step<L: Lane>(
        &self,
        among: &impl Scatterers<L>,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        (extinctions, albedo): (&TentativeCollision<L>, L),
        walks: L::Mask,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, number, .. }, real) =
            (*extinctions, extinctions.ratio());
        let hits = walks & !inside & path.is_forward;
        if hits.maybe() {
            let of_hit = self.techniques.of_hit(path.ratio);
            let weight = L::select(path.unscattered, t.each(1.0), of_hit);
            path.score.add_where(hits, weight);
        }
        let probabilities = ParticleRule::Analog.probabilities(real, albedo);
        let (scattered, null) = probabilities.decide_each(walks & inside, number);
        if self.techniques.has_nulls() {
            path.ratio.scale_where(null & !path.unscattered, real.one_minus());
        }
        if scattered.maybe() {
            self.scatter(among, path, route, t, scattered, random);
        }
        scattered | null
    }

    /// Casts the shadow rays of the walks in `scattered`, and turns these.
    #[inline(always)]
    fn scatter<L: Lane>(
        &self,
        among: &impl Scatterers<L>,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        t: L,
        scattered: L::Mask,
        random: &mut impl Random<L>,
    ) {
        let direction = random.uniform_where(scattered);
        let forward = among.forward(t);
        let phase = L::select(path.is_forward, forward, forward.one_minus());
        let techniques = self.techniques;
        let mut exact = t.each(0.0);
        match techniques.shadow {
            None => {}
            Some(Shadow::Exact) => {
                exact = self.before.transmittance(t, t.each(1.0), scattered);
                path.score.add_where(scattered, techniques.of_shadow_ray(phase, exact));
            }
            Some(Shadow::Delta | Shadow::Ratio) => {
                path.shadow.cast_where(scattered, route, phase);
            }
        }
        path.ratio.set_where(scattered, techniques.ratio(phase, exact));
        path.is_forward ^= scattered & forward.at_most(direction);
        path.unscattered &= !scattered;
    }
}

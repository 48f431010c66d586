//! The walk of a particle through a slab, `SimulateParticle` in three dimensions.
//!
//! ```text
//! begin    at the top;  μ that of the light, √u where it is diffuse;  w = 1
//! fly      −ln u |μ| deep through σ̂(z), down for μ > 0;  beyond a boundary it has left
//! collide  r = σ_t/σ̂;  as the probabilities of the rule and u say:
//!            scattered     w ← w · a r/q_s;  by an angle θ at an azimuth φ:  μ ← μ cos θ + √(1 − μ²) sin θ cos φ
//!            straight on   w ← w · (1 − r)/q_t
//!            absorbed      the end
//! see      w at the boundary where it left
//! ```
//!
//! A flight and the event at its end take a random number each; a scattering takes one for θ and one for φ, but an
//! isotropic one only the first. Diffuse light takes one for `μ₀ = √u`.

use std::f64::consts::TAU;

use crate::walks::steps::{diffuse, entering, turned};
use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Kernel, Request, Setup};
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};
use theory::ParticleRule;
use theory::problems::Slab;
use theory::problems::slab::Incidence;

kept! {
    /// Particles on their way.
    pub struct Particle<L> {
        /// μ.
        pub cosine: L,
        /// w.
        pub weight: L,
    }
}

/// A slab, and the rule of walks through it.
#[derive(Clone, Copy)]
pub struct InSlab<'a> {
    /// The light on it, and its phase function.
    pub incidence: &'a Incidence,
    /// a.
    pub albedo: f64,
    /// The rule at a collision.
    pub rule: ParticleRule,
}

impl Walk for InSlab<'_> {
    type State<L: Lane> = Particle<L>;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, which: L::Mask, rng: &mut impl Random<L>) -> Particle<L> {
        let cosine = entering(self.incidence.light, diffuse, which, one, rng);
        Particle { cosine, weight: one }
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        particle: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        route.here.fly_either_way(depth * particle.cosine.size(), is_down(particle))
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        particle: &mut Particle<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        rng: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, number, .. }, ratio) =
            (*extinctions, extinctions.ratio());
        let probabilities = self.rule.probabilities(ratio, ratio.each(self.albedo));
        let (scattered, straight_on) = probabilities.decide_each(inside, number);
        if scattered.maybe() {
            let phase = &self.incidence.phase;
            let mut cosine = phase.cosine(rng.uniform_where(scattered));
            if *phase != Phase::Isotropic(Isotropic) {
                let azimuth = (rng.uniform_where(scattered) * TAU).cos();
                cosine = turned(particle.cosine, cosine, azimuth);
            }
            particle.cosine.set_where(scattered, cosine);
        }
        let goes_on = scattered | straight_on;
        let factor =
            L::select(scattered, probabilities.scatter_weight, probabilities.transmit_weight);
        particle.weight.scale_where(goes_on, factor);
        goes_on
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        2
    }

    #[inline(always)]
    fn value<L: Lane>(&self, particle: &Particle<L>, left: L::Mask, channel: usize) -> L {
        let there = if channel == 0 { !is_down(particle) } else { is_down(particle) };
        L::select(left & there, particle.weight, particle.weight.each(0.0))
    }
}

#[inline(always)]
fn is_down<L: Lane>(particle: &Particle<L>) -> L::Mask {
    particle.cosine.each(0.0).below(particle.cosine)
}

/// Makes the draws of a request: reflectance and transmittance.
pub fn fill(rule: ParticleRule, kernel: Kernel, setup: &Setup<Slab>, request: Request) {
    walks::fill(&InSlab::of(&setup.problem, rule), kernel, setup, request);
}

impl<'a> InSlab<'a> {
    /// A slab.
    pub fn of(slab: &'a Slab, rule: ParticleRule) -> Self {
        Self { incidence: &slab.incidence, albedo: slab.albedo, rule }
    }
}

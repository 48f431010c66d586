//! The walk of a particle through a rod, `SimulateParticle` in one dimension.
//!
//! ```text
//! begin    at the front, forward;  w = 1
//! fly      on or back through an optical depth −ln u of σ̂;  beyond an end it has left
//! collide  r = σ_t/σ̂;  as the probabilities of the rule and u say:
//!            scattered     w ← w · a r/q_s;  turns round with probability 1 − p_f
//!            straight on   w ← w · (1 − r)/q_t
//!            absorbed      the end
//!          whichever it is, absorbed += w r (1 − a) and flux += w/(σ̂ width) with the w before
//!          roulette, where it is played: small |w| ← w₀ with probability |w|/w₀, else the end
//! see      w at the end where it left
//! ```
//!
//! A flight and the event at its end take a random number each; a scattering takes a third, and so does roulette.
//! [`line`] follows one particle of this walk, or sixteen side by side.

use crate::walks::steps::roulette;
use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Kernel, Request, Setup};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};
use theory::ParticleRule;
use theory::problems::Rod;
use theory::problems::rod::{MAX_PARTS, RodQuantity};

kept! {
    /// Particles on their way.
    pub struct Particle<L> {
        /// Lanes that fly forward.
        pub is_forward: L::Mask,
        /// w.
        pub weight: L,
        /// Numbers of scatterings.
        pub order: L,
        /// `Σ w r (1 − a)`.
        pub absorbed: L,
        /// `Σ w/(σ̂ width)` in each part of the rod.
        pub flux: [L; MAX_PARTS],
    }
}

/// A rod, and the rule of walks through it.
#[derive(Clone, Copy)]
pub struct InRod<'a> {
    /// The rod.
    pub rod: &'a Rod,
    /// The rule at a collision, and roulette.
    pub steps: RuleAndRoulette,
}

impl Walk for InRod<'_> {
    type State<L: Lane> = Particle<L>;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, all: L::Mask, _: &mut impl Random<L>) -> Particle<L> {
        let zero = one.each(0.0);
        let is_forward = all | !all;
        Particle { is_forward, weight: one, order: zero, absorbed: zero, flux: [zero; MAX_PARTS] }
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        particle: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        route.here.fly_either_way(depth, particle.is_forward)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        particle: &mut Particle<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        rng: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, number, .. }, ratio) =
            (*extinctions, extinctions.ratio());
        let albedo = self.rod.albedo.value(t);
        self.score(particle, extinctions, albedo);
        let probabilities = self.steps.rule.probabilities(ratio, albedo);
        let (scattered, straight_on) = probabilities.decide_each(inside, number);
        if scattered.maybe() {
            particle.weight.scale_where(scattered, probabilities.scatter_weight);
            particle.order.count_where(scattered);
            let forward = self.rod.forward.value(t);
            particle.is_forward ^= scattered & forward.at_most(rng.uniform_where(scattered));
        }
        if straight_on.maybe() {
            particle.weight.scale_where(straight_on, probabilities.transmit_weight);
        }
        roulette(self.steps.roulette, scattered | straight_on, &mut particle.weight, rng)
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.rod.channels.len()
    }

    #[inline(always)]
    fn value<L: Lane>(&self, particle: &Particle<L>, left: L::Mask, channel: usize) -> L {
        let Particle { is_forward, weight, order, absorbed, flux } = *particle;
        let of_those = |which| L::select(left & which, weight, weight.each(0.0));
        match self.rod.channels[channel] {
            RodQuantity::Absorbed => absorbed,
            RodQuantity::Flux(part) => L::one_of(&flux, part),
            RodQuantity::Transmitted => of_those(is_forward),
            RodQuantity::Reflected => of_those(!is_forward),
            RodQuantity::TransmittedBy(n) => of_those(is_forward & order.equals(n as f64)),
            RodQuantity::ReflectedBy(n) => of_those(!is_forward & order.equals(n as f64)),
        }
    }
}

impl InRod<'_> {
    /// Scores a tentative collision, before its event is decided.
    #[inline(always)]
    fn score<L: Lane>(
        &self,
        particle: &mut Particle<L>,
        extinctions: &TentativeCollision<L>,
        albedo: L,
    ) {
        let TentativeCollision { inside, t, mean_free_path, .. } = *extinctions;
        let (weight, ratio) = (particle.weight, extinctions.ratio());
        particle.absorbed.add_where(inside, weight * ratio * albedo.one_minus());
        if self.rod.parts > 0 {
            let width = self.rod.width();
            let (at, flux) =
                ((t - self.rod.begin()) / t.each(width), weight * (mean_free_path * (1.0 / width)));
            for (part, sum) in particle.flux.iter_mut().enumerate().take(self.rod.parts) {
                sum.add_where(inside & self.rod.is_in(part, at), flux);
            }
        }
    }
}

/// A rule, with or without roulette.
#[derive(Debug, Clone, Copy)]
pub struct RuleAndRoulette {
    /// The rule at a collision.
    pub rule: ParticleRule,
    /// w₀, the weight below which roulette is played.
    pub roulette: Option<f64>,
}

/// Makes the draws of a request.
pub fn fill(steps: RuleAndRoulette, kernel: Kernel, setup: &Setup<Rod>, request: Request) {
    walks::fill(&InRod { rod: &setup.problem, steps }, kernel, setup, request);
}

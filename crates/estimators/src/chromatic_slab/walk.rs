//! The walk of a hero through a slab in several channels, until it is absorbed or leaves.
//!
//! ```text
//! the hero h flies a length −ln u/σ̂_h along a direction of cosine μ, |μ| of it deep
//! a tentative collision, r = σ_t/σ̂ of each channel, is null, absorbing or scattering by the hero's probabilities:
//!   f_λ ← f_λ (1 − r_λ),   f_λ r_λ (1 − a_λ),   f_λ r_λ a_λ p_λ(cos θ)
//! ```
//!
//! f is the density of the walk in the channel λ and is kept relative to the hero's, see [`Densities`]. In spectral
//! tracking all channels walk together through one σ̂ with one phase function: probabilities `P_e` decide, and f is
//! relative to them. The choice of the hero takes one random number, diffuse light one, a flight one, a collision
//! one, a scattering one for θ and one for the azimuth.

use std::f64::consts::TAU;

use crate::Setup;
use crate::chromatic::densities::{Densities, Events, Scatterers};
use crate::chromatic::{WalkEvents, WalkerWeights};
use crate::setup::walker::Walker;
use crate::walks::hero::{HeroDistribution, LastPiece, Media, Weighing, number_of_hero};
use crate::walks::steps::{diffuse, entering, turned};
use crate::walks::{GROUPS, Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use media::body::MAX_CHANNELS;
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask, Span, kept};
use theory::problems::ChromaticSlab;
use theory::problems::channels::End;

/// The walk through a slab.
#[derive(Clone, Copy)]
pub struct InSlab<'a, S> {
    setup: &'a Setup<ChromaticSlab>,
    support: Span,
    among: Scatterers<'a, S>,
    weighing: Weighing,
    scores_all: bool,
    /// The distribution of the hero, if one is chosen.
    distribution: Option<HeroDistribution>,
    /// `1/σ̂` of each channel.
    mean_free_paths: [f64; MAX_CHANNELS],
}

impl<'a, S: WalkEvents> InSlab<'a, S> {
    /// The walk by steps on a setup.
    #[inline(always)]
    pub fn new(steps: S, by: WalkerWeights<'a>, setup: &'a Setup<ChromaticSlab>) -> Self {
        let (problem, count) = (&*setup.problem, setup.fields.len());
        let WalkerWeights { walker, weighing, scores_all } = by;
        let [mut mean_free_paths, mut probabilities] = [[0.0; MAX_CHANNELS]; 2];
        let mut phases = [problem.incidences[0].phase; MAX_CHANNELS];
        for (channel, own) in setup.fields.iter().enumerate() {
            mean_free_paths[channel] = 1.0 / own.majorant;
            phases[channel] = problem.incidences[channel].phase;
            // A walk of all channels together has the hero number 0.
            let together = if channel == 0 { 1.0 } else { 0.0 };
            let heroes = walker.heroes();
            probabilities[channel] =
                heroes.map_or(together, |heroes| heroes.probability(count, channel));
        }
        let media = Media::new(setup, &probabilities);
        let albedos = &problem.colours.albedos;
        let distribution = walker.heroes().map(|heroes| HeroDistribution::new(heroes, count));
        let among = Scatterers { media, albedos, phases, walker, steps };
        let support = setup.residual().mesh.support();
        Self { setup, support, among, weighing, scores_all, distribution, mean_free_paths }
    }
}

kept! {
    /// Walks through a slab, kept in memory.
    pub struct Particle<L> {
        /// The number of the hero, its mean free path through σ̂, its σ̂ and its albedo.
        hero: L,
        mean_free_path: L,
        majorant: L,
        albedo: L,
        /// The cosine with the normal.
        cosine: L,
        /// The beginning of the flight, and how deep it goes in mean free paths.
        before: L,
        depth: L,
        /// The length of the path, and of its last flight.
        length: L,
        last: L,
        densities: Densities<L>,
    }
}

impl<S: WalkEvents> Walk for InSlab<'_, S> {
    type State<L: Lane> = Particle<L>;

    const IS_CHROMATIC: bool = true;
    const DECIDES: bool = false;
    const PAUSES: bool = true;
    const SCORES: Scores = Scores::Later;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> Particle<L> {
        let mut path = Particle {
            hero: one,
            mean_free_path: one,
            majorant: one,
            albedo: one,
            cosine: one,
            before: one,
            depth: one,
            length: one,
            last: one,
            densities: Densities::new(one),
        };
        self.restart(&mut path, which, one, random);
        path
    }

    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        path: &mut Particle<L>,
        which: L::Mask,
        one: L,
        random: &mut impl Random<L>,
    ) {
        let Scatterers { media, albedos, .. } = &self.among;
        let (zero, count) = (one.each(0.0), media.count);
        let hero = match &self.distribution {
            Some(distribution) => distribution.choose(random.uniform_where(which)),
            None => zero,
        };
        path.hero.keep_where(which, hero);
        let mean_free_path = number_of_hero(hero, &self.mean_free_paths[..count]);
        path.mean_free_path.keep_where(which, mean_free_path);
        path.majorant.keep_where(which, number_of_hero(hero, &media.majorants[..count]));
        path.albedo.keep_where(which, number_of_hero(hero, &albedos[..count]));
        let light = self.setup.problem.incidences[0].light;
        let cosine = entering(light, diffuse, which, one, random);
        path.cosine.keep_where(which, cosine);
        path.length.keep_where(which, zero);
        if self.scores_all {
            path.densities.restart(count, which, one);
        }
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(&self, path: &Particle<L>, _: &Route<impl BothWays<L>>) -> L {
        path.mean_free_path
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Particle<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        path.before = route.here.reached();
        path.depth = depth * path.cosine;
        let is_down = depth.each(0.0).below(path.cosine);
        route.here.fly_either_way(path.depth.size(), is_down)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Particle<L>,
        _: &mut Route<impl BothWays<L>>,
        met: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, extinctions, .. }, cosine, hero) =
            (*met, path.cosine, path.hero);
        let (zero, one, support) = (hero.each(0.0), hero.each(1.0), self.support);
        let face = L::select(zero.below(cosine), one.each(support.to), one.each(support.from));
        let deep = L::select(inside, path.depth / path.majorant, face - path.before);
        path.last = self.among.steps.flown(deep, cosine);
        path.length = path.length + path.last;
        let own = path.densities.look(&self.among, hero, extinctions);
        let probabilities = path.densities.probabilities(&self.among, [own, path.albedo]);
        let [passes, scatters, _] = probabilities;
        let number = random.uniform_where(inside);
        let scattered = inside & number.below(scatters);
        let null = inside & !scattered & number.below(scatters + passes);
        let mut deflection = one;
        if scattered.any() {
            deflection = self.among.cosine(hero, random.uniform_where(scattered));
            let azimuth = (random.uniform_where(scattered) * TAU).cos();
            path.cosine.keep_where(scattered, turned(cosine, deflection, azimuth));
        }
        if self.scores_all && inside.maybe() {
            let events = Events { scattered, null, collided: inside };
            path.densities.weigh(&self.among, hero, (events, probabilities), deflection);
        }
        scattered | null
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.among.media.count
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.setup.problem.colours.seen.len()
    }

    #[inline(always)]
    fn leaves<'a, L: Lane>(
        &self,
        path: &'a Particle<L>,
        some: &'a mut [L; SOME_LEFT],
    ) -> [&'a [L]; GROUPS] {
        (some[0], some[1], some[2], some[3]) = (path.hero, path.cosine, path.length, path.last);
        let count = if self.scores_all { self.media() } else { 0 };
        [&some[..4], &path.densities.weights[..count], &[], &[], &[]]
    }

    #[inline(always)]
    fn score<L: Lane>(&self, numbers: &[L], left: L::Mask, lookups: L, values: &mut [L]) -> L {
        let (media, zero) = (&self.among.media, lookups.each(0.0));
        let [hero, cosine, mut length, last] = [numbers[0], numbers[1], numbers[2], numbers[3]];
        let (mut result, mut defect) = ([zero; MAX_CHANNELS], zero);
        let result = &mut result[..media.count];
        if self.scores_all {
            for (channel, result) in result.iter_mut().enumerate() {
                *result = numbers[4 + channel];
            }
            if self.weighing.last_piece != LastPiece::Everywhere {
                length = length - last;
            }
            media.common(hero, [length, lookups], result);
            if matches!(self.among.walker, Walker::Mis(_)) {
                let off = media.balance(self.weighing.missing, result);
                defect = L::select(left, off, zero);
            }
        } else {
            media.alone(hero, result);
        }
        let is_down = zero.below(cosine);
        for (number, &(end, channel)) in self.setup.problem.colours.seen.iter().enumerate() {
            let there = if end == End::Transmitted { is_down } else { !is_down };
            values[number] = L::select(left & there, result[channel], zero).sealed();
        }
        defect
    }
}

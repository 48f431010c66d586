//! Independent tracking: one channel a draw, by hits and shadow rays of its own.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_h = x_h/w_h, the others 0,  h of probability w_h,  x_h a draw of `full-mis` in one channel
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `technique` | `"full-mis"`: hits and shadow rays, weighted by null-scattering paths; `"unidirectional"`: hits alone | `"full-mis"` |
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel | required here or in the case |
//!
//! The colour noise is the largest possible. All moments are known.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), section 6.
//!
//! ```toml
//! title = "An example of independent"
//!
//! [problem.rod]
//! medium = [1.1, 1, 0.9]
//! span = [0, 2]
//! albedos = [0.8, 0.75, 0.7]
//! forward = [0.75, 0.75, 0.75]
//! light = "emitter"
//! sampling = 1.6
//! estimators = ["independent"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Albedos, realisable, spectrum};
use crate::lit_rod::walk::{Path, Scatterers, ToEmitter};
use crate::setup::heroes::Heroes;
use crate::walks::hero::{HeroDistribution, number_of_hero, of_hero, or_of_hero};
use crate::walks::{Route, TentativeCollision, Walk, drawn};
use crate::{Estimator, Inputs, Refusal, Setup, Traits};
use media::body::MAX_CHANNELS;
use media::catalogue::Settings;
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, kept};
use theory::Prediction;
use theory::problems::SpectralLitRod;
use theory::rod::lit::spectral::{FULL, HITS, LitTracker};

/// Independent tracking.
#[derive(Debug, Clone)]
pub struct Independent {
    is_full: bool,
    heroes: Heroes,
}

impl Independent {
    #[inline(always)]
    fn walk<'a>(&self, setup: &'a Setup<SpectralLitRod>, albedos: Albedos<'a>) -> OfHero<'a> {
        let (count, first) = (setup.fields.len(), &setup.fields[0]);
        let [mut mean_free_paths, mut probabilities] = [[0.0; MAX_CHANNELS]; 2];
        for (channel, own) in setup.fields.iter().enumerate() {
            mean_free_paths[channel] = 1.0 / own.majorant;
            probabilities[channel] = self.heroes.probability(count, channel);
        }
        let (rod, end) = (&setup.problem.rods[0].rod, first.mesh.support().to);
        let techniques = if self.is_full { FULL } else { HITS };
        OfHero {
            walk: ToEmitter::new(rod, end, techniques),
            distribution: HeroDistribution::new(&self.heroes, count),
            count,
            mean_free_paths,
            probabilities,
            forward: &setup.problem.forward,
            albedos,
        }
    }
}

impl Estimator<SpectralLitRod> for Independent {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let technique = settings.word_or("technique", &["full-mis", "unidirectional"], "full-mis");
        let heroes = Heroes::read(settings);
        Some(Self { is_full: technique? == "full-mis", heroes: heroes? })
    }

    fn traits(&self) -> Traits {
        let technique = if self.is_full { "full-mis" } else { "unidirectional" };
        let heroes = self.heroes.label();
        let settings =
            if heroes.is_empty() { technique.into() } else { format!("{technique}, {heroes}") };
        Traits { settings, ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<SpectralLitRod>) -> Result<(), Refusal> {
        realisable(setup, &self.heroes)
    }

    fn predict(&self, setup: &Setup<SpectralLitRod>) -> Prediction {
        let tracker = LitTracker::Independent { casts: self.is_full };
        spectrum(setup, &self.heroes, tracker).predict(setup.distributions)
    }

    drawn!(self, setup: SpectralLitRod =>
        self.walk(setup, Albedos::of(setup)),
        self.walk(setup, Albedos::found(setup))
    );
}

kept! {
    /// Walks through the media of their heroes.
    pub struct Alone<L> {
        /// The number of the hero, its mean free path, and its probability to keep the direction.
        hero: L,
        mean_free_path: L,
        forward: L,
        path: Path<L>,
    }
}

/// A walk through the medium of its hero.
#[derive(Clone, Copy)]
struct OfHero<'a> {
    walk: ToEmitter<'a>,
    distribution: HeroDistribution,
    count: usize,
    mean_free_paths: [f64; MAX_CHANNELS],
    probabilities: [f64; MAX_CHANNELS],
    forward: &'a [f64],
    albedos: Albedos<'a>,
}

/// The present σ_t and albedo of the heroes' media.
struct Own<L> {
    albedo: L,
    forward: L,
}

impl<L: Lane> Scatterers<L> for Own<L> {
    #[inline(always)]
    fn albedo(&self, _: L) -> L {
        self.albedo
    }

    #[inline(always)]
    fn forward(&self, _: L) -> L {
        self.forward
    }
}

impl Walk for OfHero<'_> {
    type State<L: Lane> = Alone<L>;

    const IS_CHROMATIC: bool = true;
    const PAUSES: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, which: L::Mask, random: &mut impl Random<L>) -> Alone<L> {
        let path = self.walk.begin(one, which, random);
        let mut alone = Alone { hero: one, mean_free_path: one, forward: one, path };
        self.restart(&mut alone, which, one, random);
        alone
    }

    #[inline(always)]
    fn restart<L: Lane>(
        &self,
        alone: &mut Alone<L>,
        which: L::Mask,
        one: L,
        random: &mut impl Random<L>,
    ) {
        self.walk.restart(&mut alone.path, which, one, random);
        let (hero, count) = (self.distribution.choose(random.uniform_where(which)), self.count);
        let mean_free_path = number_of_hero(hero, &self.mean_free_paths[..count]);
        alone.hero.set_where(which, hero);
        alone.mean_free_path.set_where(which, mean_free_path);
        alone.forward.set_where(which, number_of_hero(hero, &self.forward[..count]));
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        alone: &mut Alone<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        self.walk.fly(&mut alone.path, route, depth)
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(&self, alone: &Alone<L>, _: &Route<impl BothWays<L>>) -> L {
        alone.mean_free_path
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        alone: &mut Alone<L>,
        route: &mut Route<impl BothWays<L>>,
        collided: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (hero, mut albedo) = (alone.hero, collided.t);
        for channel in 0..self.count {
            albedo = or_of_hero(hero, channel, albedo, self.albedos.at(channel, collided.t));
        }
        let collided =
            TentativeCollision { extinction: of_hero(hero, collided.extinctions), ..*collided };
        let own = Own { albedo, forward: alone.forward };
        self.walk.collide_among(&own, &mut alone.path, route, &collided, random)
    }

    #[inline(always)]
    fn media(&self) -> usize {
        self.count
    }

    #[inline(always)]
    fn channels(&self) -> usize {
        self.count
    }

    #[inline(always)]
    fn value<L: Lane>(&self, alone: &Alone<L>, left: L::Mask, channel: usize) -> L {
        let score = self.walk.value(&alone.path, left, 0);
        let own = score / score.each(self.probabilities[channel]);
        L::select(alone.hero.equals(channel as f64), own, score.each(0.0))
    }
}

//! Wrong walks in the infinite medium: directions and endings.
//!
//! ```text
//! E[x²] at absorption = 2/(σ_t² (1 − a)(1 − a g)) knows how a particle turns, the collisions how it ends
//! ```

use super::target::{INFINITE_ANALOG, INFINITE_WEIGHTED, Target};
use super::{About, Mutant, with};
use crate::estimators::infinite_medium::draw_with;
use crate::estimators::space::{Particle, Steps};
use crate::estimators::{Draw, Setup};
use crate::geometry::{Point, frame};
use crate::media::Lookups;
use crate::phase::Phase;
use crate::problems::InfiniteMedium;
use crate::problems::infinite_medium::Values;
use crate::rng::Stream;
use crate::theory::{Odds, ParticleRule};

use ParticleRule::{Analog, Weighted};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<InfiniteMedium>> {
    let analog = Particle::of(Analog);
    let weighted = Particle { roulette: Some(0.5), ..Particle::of(Weighted) };
    vec![
        infinite("infinite-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", INFINITE_ANALOG, analog, Turned::BACKWARD),
        infinite("infinite-turned-about-z", "a particle turns about the z axis, not about its direction", INFINITE_ANALOG, analog, Turned::ABOUT_Z),
        infinite("infinite-albedo-twice", "absorption by weight and by roulette at once", INFINITE_WEIGHTED, weighted, AlbedoTwice(weighted)),
        infinite("infinite-roulette-uncompensated", "who survives roulette keeps the old weight", INFINITE_WEIGHTED, weighted, Uncompensated(weighted)),
    ]
}

fn infinite(
    name: &'static str,
    bug: &'static str,
    target: Target,
    honest: Particle,
    steps: impl Steps + Clone + Send + Sync + 'static,
) -> Mutant<InfiniteMedium> {
    Mutant::new(About { name, bug, target, check: "mean" }, with(steps, walk), with(honest, walk))
}

/// A walk by its steps.
fn walk<S: Steps>(
    steps: &S,
    setup: &Setup<InfiniteMedium>,
    _: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    draw_with(steps, setup, rng)
}

/// Delta tracking that turns wrongly.
#[derive(Clone)]
struct Turned {
    sign: f64,
    about: Option<Point>,
}

impl Turned {
    const BACKWARD: Self = Self { sign: -1.0, about: None };
    const ABOUT_Z: Self = Self { sign: 1.0, about: Some(Point([0.0, 0.0, 1.0])) };
}

impl Steps for Turned {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        Analog.odds(ratio, albedo)
    }

    fn deflection(&self, phase: &Phase, rng: &mut Stream) -> f64 {
        self.sign * phase.cosine(rng.uniform())
    }

    fn turned(&self, direction: Point, cosine: f64, turns: f64) -> Point {
        frame::turned(self.about.unwrap_or(direction), cosine, turns)
    }
}

/// `a² r`.
#[derive(Clone)]
struct AlbedoTwice(Particle);

impl Steps for AlbedoTwice {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        let right = self.0.odds_at(ratio, albedo);
        Odds { scatter_weight: albedo * right.scatter_weight, ..right }
    }

    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        self.0.keep(rng, weight)
    }
}

/// w for w₀.
#[derive(Clone)]
struct Uncompensated(Particle);

impl Steps for Uncompensated {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        self.0.odds_at(ratio, albedo)
    }

    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        self.0.keep(rng, weight).map(|_| weight)
    }
}

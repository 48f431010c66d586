//! Wrong walks in a furnace: weights that do not add up.
//!
//! ```text
//! Σ w r (1 − a) + w where it leaves = 1 on average, and in every draw where a rule never ends a walk
//! ```

use super::target::{
    FURNACE_ANALOG, FURNACE_BELOW, FURNACE_NON_TERMINATING, FURNACE_ROULETTE, Target,
};
use super::{About, Mutant, with};
use crate::estimators::furnace::draw_with;
use crate::estimators::space::{Particle, Steps};
use crate::estimators::{Draw, Setup};
use crate::media::Lookups;
use crate::problems::Furnace;
use crate::rng::Stream;
use crate::theory::{Odds, ParticleRule};

use ParticleRule::{Analog, NonTerminating, Terminating};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Furnace>> {
    let roulette = Particle { roulette: Some(0.8), ..of(NonTerminating) };
    vec![
        furnace("furnace-albedo-twice", "the albedo is a chance and a weight", FURNACE_NON_TERMINATING, of(NonTerminating), AlbedoTwice),
        furnace("furnace-roulette-uncompensated", "who survives roulette keeps the old weight", FURNACE_ROULETTE, roulette, Uncompensated),
        furnace("furnace-terminating-beyond", "the terminating rule where r > 2/(a + 1)", FURNACE_BELOW, of(NonTerminating), of(Terminating)),
        furnace("furnace-number-twice", "one random number for the flight and for what follows it", FURNACE_ANALOG, of(Analog), NumberTwice),
    ]
}

fn of(rule: ParticleRule) -> Particle {
    Particle::of(rule)
}

fn furnace(
    name: &'static str,
    bug: &'static str,
    target: Target,
    honest: Particle,
    steps: impl Steps + Clone + Send + Sync + 'static,
) -> Mutant<Furnace> {
    Mutant::new(About { name, bug, target, check: "mean" }, with(steps, walk), with(honest, walk))
}

/// A walk by its steps.
fn walk<S: Steps>(
    steps: &S,
    setup: &Setup<Furnace>,
    _: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    draw_with(steps, setup, rng)
}

/// `a² r`.
#[derive(Clone)]
struct AlbedoTwice;

impl Steps for AlbedoTwice {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        let right = NonTerminating.odds(ratio, albedo);
        Odds { scatter_weight: albedo * right.scatter_weight, ..right }
    }
}

/// w for w₀.
#[derive(Clone)]
struct Uncompensated;

impl Steps for Uncompensated {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        NonTerminating.odds(ratio, albedo)
    }

    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        let below = 0.8;
        (weight.abs() >= below || rng.uniform() * below < weight.abs()).then_some(weight)
    }
}

/// `u` for both.
#[derive(Clone)]
struct NumberTwice;

impl Steps for NumberTwice {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        Analog.odds(ratio, albedo)
    }

    fn depth(&self, rng: &mut Stream) -> (f64, Option<f64>) {
        let number = 1.0 - rng.uniform();
        (-crate::numeric::Lane::ln(number), Some(number))
    }
}

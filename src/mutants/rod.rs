//! Wrong walks through a rod.
//!
//! ```text
//! scattered with chance q_s and weight a r w/q_s, straight on with q_t and (1 − r) w/q_t; a scattered
//! particle goes on in its direction with probability p_f
//! ```

use super::target::{
    ROD_ADAPTIVE, ROD_ANALOG, ROD_NON_TERMINATING, ROD_ROULETTE, ROD_TERMINATING, ROD_WEIGHTED,
    Target,
};
use super::{About, Mutant, with};
use crate::estimators::rod::roulette::Roulette;
use crate::estimators::rod::walk::{self, Steps};
use crate::problems::Rod;
use crate::rng::Stream;
use crate::theory::{Odds, ParticleRule};

use ParticleRule::{Adaptive, Analog, NonTerminating, Terminating, Weighted};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Rod>> {
    vec![
        rod("rod-albedo-twice", "the albedo is a chance and a weight", ROD_TERMINATING, "mean", Terminating, Changed(Terminating, albedo_twice)),
        rod("rod-albedo-in-transmission", "what goes straight on is multiplied by the albedo too", ROD_WEIGHTED, "mean", Weighted, Changed(Weighted, albedo_straight_on)),
        rod("rod-terminating-beyond", "the terminating rule where r > 2/(a + 1)", ROD_ADAPTIVE, "mean", Adaptive, Terminating),
        rod("rod-sign-lost", "the weight of what goes straight on keeps its sign where r > 1", ROD_NON_TERMINATING, "mean", NonTerminating, Changed(NonTerminating, unsigned)),
        rod("rod-undivided", "what is scattered is not divided by its chance", ROD_NON_TERMINATING, "mean", NonTerminating, Changed(NonTerminating, undivided)),
        rod("rod-one-number", "the number that decided the collision decides the direction too", ROD_ANALOG, "mean", Analog, OneNumber),
        rod("rod-forward-for-backward", "forward and backward are mixed up", ROD_ANALOG, "mean", Analog, MixedUp),
        rod("rod-analog-for-weighted", "absorption by roulette and by weight at once", ROD_WEIGHTED, "mean", Weighted, Changed(Analog, albedo_twice)),
        rod("rod-roulette-uncompensated", "what survives roulette keeps its weight", ROD_ROULETTE, "mean", Roulette { below: 0.5 }, Killed),
    ]
}

fn rod(
    name: &'static str,
    bug: &'static str,
    target: Target,
    check: &'static str,
    honest: impl Steps + Copy + Send + Sync + 'static,
    steps: impl Steps + Copy + Send + Sync + 'static,
) -> Mutant<Rod> {
    Mutant::new(
        About { name, bug, target, check },
        with(steps, walk::draw),
        with(honest, walk::draw),
    )
}

/// The odds of a rule, changed; the second argument is the albedo.
#[derive(Clone, Copy)]
struct Changed(ParticleRule, fn(Odds, f64) -> Odds);

impl Steps for Changed {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        (self.1)(self.0.odds(ratio, albedo), albedo)
    }
}

/// `a² r`.
fn albedo_twice(right: Odds, albedo: f64) -> Odds {
    Odds { scatter_weight: albedo * right.scatter_weight, ..right }
}

/// `a (1 − r)`.
fn albedo_straight_on(right: Odds, albedo: f64) -> Odds {
    Odds { transmit_weight: albedo * right.transmit_weight, ..right }
}

/// `|1 − r|`.
fn unsigned(right: Odds, _: f64) -> Odds {
    Odds { transmit_weight: right.transmit_weight.abs(), ..right }
}

/// `a r` for `a r/q_s`.
fn undivided(right: Odds, _: f64) -> Odds {
    Odds { scatter_weight: right.scatter * right.scatter_weight, ..right }
}

/// Roulette without compensation.
#[derive(Clone, Copy)]
struct Killed;

impl Steps for Killed {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        NonTerminating.odds(ratio, albedo)
    }

    #[inline(always)]
    fn keep(&self, rng: &mut Stream, weight: f64) -> Option<f64> {
        Roulette { below: 0.5 }.keep(rng, weight).map(|_| weight)
    }
}

/// The numbers that scatter lie in `[0, q_s)`: none of them is uniform in `[0, 1)`.
#[derive(Clone, Copy)]
struct OneNumber;

impl Steps for OneNumber {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        Analog.odds(ratio, albedo)
    }

    #[inline(always)]
    fn direction(&self, _: &mut Stream, decided: f64) -> f64 {
        decided
    }
}

/// A particle turns round with probability `p_f`.
#[derive(Clone, Copy)]
struct MixedUp;

impl Steps for MixedUp {
    #[inline(always)]
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        Analog.odds(ratio, albedo)
    }

    #[inline(always)]
    fn turns(&self, number: f64, forward: f64) -> bool {
        number < forward
    }
}

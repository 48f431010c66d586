//! Wrong walks through a rod.
//!
//! ```text
//! scattered with chance q_s and weight a r w/q_s, straight on with q_t and (1 − r) w/q_t; a scattered
//! particle goes on in its direction with probability p_f
//! ```

use super::scattering::{Steps, albedo_twice, of, roulette};
use super::target::{
    ROD_ADAPTIVE, ROD_ANALOG, ROD_NON_TERMINATING, ROD_ROULETTE, ROD_TERMINATING, ROD_WEIGHTED,
};
use super::{About, Mutant, with};
use estimators::rod::walk::draw;
use theory::Odds;
use theory::ParticleRule::{Adaptive, Analog, NonTerminating, Terminating, Weighted};
use theory::problems::Rod;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Rod>> {
    let rod = |name, bug, target, honest: Steps, wrong: Steps| {
        Mutant::new(About { name, bug, target, check: "mean" }, with(wrong, draw), with(honest, draw))
    };
    let (analog, non_terminating, halved) = (of(Analog), of(NonTerminating), roulette(NonTerminating, 0.5));
    vec![
        rod("rod-albedo-twice", "the albedo is a chance and a weight", ROD_TERMINATING, of(Terminating), Steps { odds: albedo_twice, ..of(Terminating) }),
        rod("rod-albedo-in-transmission", "what goes straight on is multiplied by the albedo too", ROD_WEIGHTED, of(Weighted), Steps { odds: albedo_straight_on, ..of(Weighted) }),
        rod("rod-terminating-beyond", "the terminating rule where r > 2/(a + 1)", ROD_ADAPTIVE, of(Adaptive), of(Terminating)),
        rod("rod-sign-lost", "the weight of what goes straight on keeps its sign where r > 1", ROD_NON_TERMINATING, non_terminating, Steps { odds: unsigned, ..non_terminating }),
        rod("rod-undivided", "what is scattered is not divided by its chance", ROD_NON_TERMINATING, non_terminating, Steps { odds: undivided, ..non_terminating }),
        rod("rod-one-number", "the number that decided the collision decides the direction too", ROD_ANALOG, analog, Steps { direction: |_, decided| decided, ..analog }),
        rod("rod-forward-for-backward", "forward and backward are mixed up", ROD_ANALOG, analog, Steps { turns: |number, forward| number < forward, ..analog }),
        rod("rod-analog-for-weighted", "absorption by roulette and by weight at once", ROD_WEIGHTED, of(Weighted), Steps { odds: albedo_twice, ..analog }),
        rod("rod-roulette-uncompensated", "what survives roulette keeps its weight", ROD_ROULETTE, halved, Steps { kept: |before, _| before, ..halved }),
    ]
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

//! Wrong walks through a rod.
//!
//! ```text
//! scattered with chance q_s and weight a r w/q_s, straight on with q_t and (1 − r) w/q_t; a scattered
//! particle goes on in its direction with probability p_f
//! ```

use super::target::{
    ROD_ADAPTIVE, ROD_ANALOG, ROD_NON_TERMINATING, ROD_ROULETTE, ROD_TERMINATING, ROD_WEIGHTED,
};
use super::{About, Mutant, filled};
use estimators::rod::walk::{By, Steps, fill};
use numeric::Lane;
use numeric::rng::Random;
use theory::Odds;
use theory::ParticleRule::{Adaptive, Analog, NonTerminating, Terminating, Weighted};
use theory::problems::Rod;

#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    AlbedoTwice,
    AlbedoStraightOn,
    SignLost,
    Undivided,
    OneNumber,
    Backward,
    Uncompensated,
}

/// Steps, of which a bug makes one wrong.
#[derive(Clone, Copy)]
struct Wrong(By, Bug);

impl Steps for Wrong {
    #[inline(always)]
    fn odds<L: Lane>(&self, ratio: L, albedo: L) -> Odds<L> {
        let right = self.0.odds(ratio, albedo);
        let Odds { scatter, scatter_weight, transmit_weight, .. } = right;
        match self.1 {
            Bug::AlbedoTwice => Odds { scatter_weight: albedo * scatter_weight, ..right },
            Bug::AlbedoStraightOn => Odds { transmit_weight: albedo * transmit_weight, ..right },
            Bug::SignLost => Odds { transmit_weight: transmit_weight.size(), ..right },
            Bug::Undivided => Odds { scatter_weight: scatter * scatter_weight, ..right },
            _ => right,
        }
    }

    #[inline(always)]
    fn turns<L: Lane>(
        &self,
        scattered: L::Mask,
        forward: L,
        decided: L,
        rng: &mut impl Random<L>,
    ) -> L::Mask {
        match self.1 {
            Bug::OneNumber => scattered & forward.at_most(decided),
            Bug::Backward => scattered & rng.uniform_where(scattered).below(forward),
            _ => self.0.turns(scattered, forward, decided, rng),
        }
    }

    #[inline(always)]
    fn survive<L: Lane>(
        &self,
        goes_on: L::Mask,
        weight: &mut L,
        rng: &mut impl Random<L>,
    ) -> L::Mask {
        let before = *weight;
        let survives = self.0.survive(goes_on, weight, rng);
        if self.1 == Bug::Uncompensated {
            *weight = before;
        }
        survives
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Rod>> {
    let of = |rule| By { rule, roulette: None };
    let rod = |name, bug, target, honest: By, wrong: Wrong| {
        Mutant::new(About { name, bug, target, check: "mean" }, filled(wrong, fill), filled(Wrong(honest, Bug::None), fill))
    };
    let (analog, non_terminating, halved) = (of(Analog), of(NonTerminating), By { rule: NonTerminating, roulette: Some(0.5) });
    vec![
        rod("rod-albedo-twice", "the albedo is a chance and a weight", ROD_TERMINATING, of(Terminating), Wrong(of(Terminating), Bug::AlbedoTwice)),
        rod("rod-albedo-in-transmission", "what goes straight on is multiplied by the albedo too", ROD_WEIGHTED, of(Weighted), Wrong(of(Weighted), Bug::AlbedoStraightOn)),
        rod("rod-terminating-beyond", "the terminating rule where r > 2/(a + 1)", ROD_ADAPTIVE, of(Adaptive), Wrong(of(Terminating), Bug::None)),
        rod("rod-sign-lost", "the weight of what goes straight on keeps its sign where r > 1", ROD_NON_TERMINATING, non_terminating, Wrong(non_terminating, Bug::SignLost)),
        rod("rod-undivided", "what is scattered is not divided by its chance", ROD_NON_TERMINATING, non_terminating, Wrong(non_terminating, Bug::Undivided)),
        rod("rod-one-number", "the number that decided the collision decides the direction too", ROD_ANALOG, analog, Wrong(analog, Bug::OneNumber)),
        rod("rod-forward-for-backward", "forward and backward are mixed up", ROD_ANALOG, analog, Wrong(analog, Bug::Backward)),
        rod("rod-analog-for-weighted", "absorption by roulette and by weight at once", ROD_WEIGHTED, of(Weighted), Wrong(analog, Bug::AlbedoTwice)),
        rod("rod-roulette-uncompensated", "what survives roulette keeps its weight", ROD_ROULETTE, halved, Wrong(halved, Bug::Uncompensated)),
    ]
}

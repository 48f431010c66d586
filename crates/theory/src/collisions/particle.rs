//! Events of a particle at a tentative collision: the single particle model with scattering.
//!
//! With `r = σ_t/σ̂` and the albedo a, the incoming weight w must leave as `a r w` into the scattered
//! direction and as `(1 − r) w` straight on, on average. One particle at most is kept:
//!
//! ```text
//! straight on with probability q_t and weight (1 − r) w/q_t
//! scattered   with probability q_s and weight  a r w/q_s
//! absorbed    otherwise
//!
//! rule             q_t                 q_s                            exists for
//! terminating      |1 − r|             a r                            0 ≤ r ≤ 2/(a + 1)
//! non-terminating  |1 − r|/D           a|r|/D,  D = a|r| + |1 − r|    every r
//! adaptive         terminating where r ≥ 1 and a r + |1 − r| ≤ 1, elsewhere non-terminating
//! analog           1 − r               a r                            0 ≤ r ≤ 1
//! weighted         |1 − r|/D           |r|/D,   D =  |r| + |1 − r|    every r
//! ```
//!
//! Theory needs the k-th moments of the weights after the collision, `Q_k = q_t((1 − r)/q_t)^k` straight on and
//! `S_k = q_s(a r/q_s)^k` scattered: `Q_1 = 1 − r` and `S_1 = a r` for every rule. The probabilities are
//! differences from 1, so that the smaller one has few digits: moments are computed from these means instead.
//!
//! Where `0 ≤ r ≤ 1`, terminating is analog; the two differ in the ratios that they refuse. `weighted` is
//! non-terminating with the probabilities of a = 1: the albedo is left to the weight.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! sections 3.1–3.3 and 4.1, Eqs. 9 and 12 and `SimulateParticle`; `analog` and `weighted`: B. Miller,
//! I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.2.

use crate::Kernel;
use numeric::Lane;

/// Probabilities of the events at a tentative collision, and the factors of the weight.
///
/// Unbiased where `transmit · transmit_weight = 1 − r` and `scatter · scatter_weight = a r`. The rest of the
/// probability is absorption.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EventProbabilities<L = f64> {
    /// `q_t`, the probability to go straight on: the collision is null.
    pub transmit: L,
    /// `q_s`, the probability to be scattered.
    pub scatter: L,
    /// `(1 − r)/q_t`, the factor of a particle that goes straight on.
    pub transmit_weight: L,
    /// `a r/q_s`, the factor of a particle that is scattered.
    pub scatter_weight: L,
}

/// Event at a collision.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// Straight on.
    Transmitted,
    /// Into a new direction.
    Scattered,
    /// The end of the walk.
    Absorbed,
}

impl EventProbabilities {
    /// Kernel of the k-th moment at a rate of collisions, with `Q_k = q_t((1 − r)/q_t)^k` and `S_k = q_s(a r/q_s)^k`,
    /// given the means `1 − r` and `a r`.
    #[inline]
    pub fn kernel(&self, rate: f64, means: [f64; 2], k: i32) -> Kernel {
        let weights = [self.transmit_weight, self.scatter_weight];
        let [straight, scattered] = if k == 0 {
            [self.transmit, self.scatter]
        } else {
            [0, 1].map(|event| means[event] * weights[event].powi(k - 1))
        };
        Kernel { rate, straight, scattered, score: 0.0 }
    }

    /// Event that a uniform number chooses: scattering first, as in `SimulateParticle`.
    #[inline(always)]
    pub fn decide(&self, number: f64) -> Event {
        if number < self.scatter {
            Event::Scattered
        } else if number < self.scatter + self.transmit {
            Event::Transmitted
        } else {
            Event::Absorbed
        }
    }
}

/// Ratios `r = σ_t/σ̂` for which a rule has probabilities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RatioRange {
    /// Every r.
    Every,
    /// `0 ≤ r ≤ 1`: σ̂ is a majorant.
    Majorant,
    /// `0 ≤ r ≤ 2/(a + 1)`.
    Terminating,
}

/// Rule that sets the probabilities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParticleRule {
    /// The weight keeps its size, for `0 ≤ r ≤ 2/(a + 1)` (Eq. 9).
    Terminating,
    /// The walk never ends inside the medium, for every r (Eq. 12).
    NonTerminating,
    /// One of the two, as `SimulateParticle` chooses.
    Adaptive,
    /// Delta tracking: real with probability r, then absorbed with probability `1 − a`; for `0 ≤ r ≤ 1`.
    Analog,
    /// Delta tracking with the albedo as a weight, continued beyond `0 ≤ r ≤ 1` by weights.
    Weighted,
}

impl ParticleRule {
    /// All rules.
    pub const ALL: [Self; 5] =
        [Self::Terminating, Self::NonTerminating, Self::Adaptive, Self::Analog, Self::Weighted];

    /// The name in case files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terminating => "terminating",
            Self::NonTerminating => "non-terminating",
            Self::Adaptive => "adaptive",
            Self::Analog => "analog",
            Self::Weighted => "weighted",
        }
    }

    /// Probabilities and weights at a collision of ratio `r = σ_t/σ̂` for an albedo in `[0, 1]`.
    ///
    /// Outside the range of [`ParticleRule::limits`] they are what the formula gives and no probabilities: draws
    /// that are made in spite of that compare a number with them as any renderer would, and are biased.
    #[inline(always)]
    pub fn probabilities<L: Lane>(self, ratio: L, albedo: L) -> EventProbabilities<L> {
        let one = ratio.each(1.0);
        match self {
            Self::Terminating | Self::Analog => terminating(ratio, albedo),
            Self::NonTerminating => shared(ratio, albedo, one),
            Self::Adaptive => {
                let sum = albedo * ratio + (one - ratio).size();
                let terminates = one.at_most(ratio) & sum.at_most(one);
                let (ending, lasting) = (terminating(ratio, albedo), shared(ratio, albedo, one));
                EventProbabilities::select(terminates, ending, lasting)
            }
            Self::Weighted => shared(ratio, one, albedo),
        }
    }

    /// Ratios for which they are probabilities.
    pub fn range(self) -> RatioRange {
        match self {
            Self::Terminating => RatioRange::Terminating,
            Self::Analog => RatioRange::Majorant,
            Self::NonTerminating | Self::Adaptive | Self::Weighted => RatioRange::Every,
        }
    }

    /// The smallest and the largest r for which they are probabilities.
    pub fn limits(self, albedo: f64) -> [f64; 2] {
        match self.range() {
            RatioRange::Terminating => [0.0, 2.0 / (albedo + 1.0)],
            RatioRange::Majorant => [0.0, 1.0],
            RatioRange::Every => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }

    /// The ratios at which the probabilities or one of their derivatives jump: panels end there.
    pub fn kinks(self, albedo: f64) -> Vec<f64> {
        match self {
            Self::Adaptive => vec![0.0, 1.0, 2.0 / (1.0 + albedo)],
            Self::Terminating | Self::NonTerminating | Self::Analog | Self::Weighted => {
                vec![0.0, 1.0]
            }
        }
    }
}

impl<L: Lane> EventProbabilities<L> {
    /// Returns the lanes of `which` that are scattered, and those that go straight on, given uniform numbers.
    #[inline(always)]
    pub fn decide_each(&self, which: L::Mask, number: L) -> (L::Mask, L::Mask) {
        let scattered = which & number.below(self.scatter);
        (scattered, which & !scattered & number.below(self.scatter + self.transmit))
    }

    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            transmit: L::select(mask, yes.transmit, no.transmit),
            scatter: L::select(mask, yes.scatter, no.scatter),
            transmit_weight: L::select(mask, yes.transmit_weight, no.transmit_weight),
            scatter_weight: L::select(mask, yes.scatter_weight, no.scatter_weight),
        }
    }
}

/// The absolute value of one number with the sign of another.
#[inline(always)]
fn signed<L: Lane>(size: L, like: L) -> L {
    L::select(like.below(like.each(0.0)), -size, size)
}

#[inline(always)]
fn terminating<L: Lane>(ratio: L, albedo: L) -> EventProbabilities<L> {
    let one = ratio.each(1.0);
    let rest = one - ratio;
    EventProbabilities {
        transmit: rest.size(),
        scatter: albedo * ratio,
        transmit_weight: signed(one, rest),
        scatter_weight: one,
    }
}

/// Probabilities in proportion to `|1 − r|` and `albedo |r|`, so that the walk always goes on: the weight has their
/// sum as a factor. Scattered weights have the further factor `left`.
#[inline(always)]
fn shared<L: Lane>(ratio: L, albedo: L, left: L) -> EventProbabilities<L> {
    let (zero, one) = (ratio.each(0.0), ratio.each(1.0));
    let rest = one - ratio;
    let (transmitted, scattered) = (rest.size(), albedo * ratio.size());
    let sum = scattered + transmitted;
    let transmit = transmitted / sum;
    // r = 1 and a = 0: the particle keeps no weight, whatever the probabilities. A weight of 0 is no weight either:
    // the walk ends.
    let is_nothing = sum.at_most(zero);
    let is_scattered = zero.below(left) & !is_nothing;
    EventProbabilities {
        transmit: L::select(is_nothing, zero, transmit),
        scatter: L::select(is_scattered, one - transmit, zero),
        transmit_weight: signed(sum, rest),
        scatter_weight: left * signed(sum, ratio),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALBEDOS: [f64; 5] = [0.0, 0.3, 0.7, 0.9, 1.0];

    fn ratios() -> impl Iterator<Item = f64> {
        (-40..=80).map(|step| 0.05 * f64::from(step))
    }

    fn holds(rule: ParticleRule, ratio: f64, albedo: f64) -> bool {
        let [minimum, maximum] = rule.limits(albedo);
        (minimum..=maximum).contains(&ratio)
    }

    #[test]
    fn every_rule_keeps_both_means_where_it_exists() {
        for rule in ParticleRule::ALL {
            for albedo in ALBEDOS {
                for r in ratios().filter(|&r| holds(rule, r, albedo)) {
                    let probabilities = rule.probabilities(r, albedo);
                    let context = format!("{rule:?} at r = {r}, a = {albedo}");
                    let means = [1.0 - r, albedo * r];
                    let result = [
                        probabilities.transmit * probabilities.transmit_weight,
                        probabilities.scatter * probabilities.scatter_weight,
                    ];
                    for (result, mean) in result.into_iter().zip(means) {
                        assert!((result - mean).abs() < 1e-14, "{context}");
                    }
                    assert!(
                        probabilities.transmit >= 0.0 && probabilities.scatter >= 0.0,
                        "{context}"
                    );
                    assert!(
                        probabilities.transmit + probabilities.scatter <= 1.0 + 1e-15,
                        "{context}"
                    );
                }
            }
        }
    }

    #[test]
    fn beyond_its_limits_a_rule_has_no_chances() {
        for (rule, r) in [(ParticleRule::Terminating, 1.2), (ParticleRule::Terminating, -0.1)] {
            let probabilities = rule.probabilities(r, 0.9);
            let sum = probabilities.transmit + probabilities.scatter;
            assert!(probabilities.scatter < 0.0 || sum > 1.0, "{probabilities:?}");
            assert!(!holds(rule, r, 0.9));
        }
        assert!(holds(ParticleRule::Terminating, 2.0 / 1.9, 0.9));
        assert!(!holds(ParticleRule::Analog, 1.01, 0.9) && holds(ParticleRule::Analog, 1.0, 0.9));
    }

    #[test]
    fn at_one_collision_the_odds_are_those_worked_by_hand() {
        // r = 1.5, a = 0.2: terminating 0.5 and 0.3 with weights −1 and 1.
        let probabilities = ParticleRule::Terminating.probabilities(1.5, 0.2);
        assert!(
            (probabilities.transmit - 0.5).abs() < 1e-15
                && (probabilities.scatter - 0.3).abs() < 1e-15
        );
        assert_eq!((probabilities.transmit_weight, probabilities.scatter_weight), (-1.0, 1.0));
        assert_eq!(ParticleRule::Adaptive.probabilities(1.5, 0.2), probabilities);
        // a r + |1 − r| = 0.9·1.5 + 0.5 = 1.85: not terminating, D = 1.85.
        let probabilities = ParticleRule::Adaptive.probabilities(1.5, 0.9);
        assert!((probabilities.transmit - 0.5 / 1.85).abs() < 1e-15);
        assert!((probabilities.transmit_weight + 1.85).abs() < 1e-15);
        assert!((probabilities.scatter_weight - 1.85).abs() < 1e-15);
        // r = −0.5, a = 0.6: D = 0.3 + 1.5, and the scattered weight changes sign.
        let probabilities = ParticleRule::NonTerminating.probabilities(-0.5, 0.6);
        assert!((probabilities.scatter - 0.3 / 1.8).abs() < 1e-15);
        assert!((probabilities.scatter_weight + 1.8).abs() < 1e-15);
        // Delta tracking with the albedo as a weight.
        let probabilities = ParticleRule::Weighted.probabilities(0.25, 0.6);
        assert!(
            (probabilities.scatter - 0.25).abs() < 1e-15 && probabilities.scatter_weight == 0.6
        );
    }

    #[test]
    fn adaptive_second_moments_are_never_below_those_of_non_terminating() {
        // S_2 and Q_2 of the terminating rule are those of the non-terminating one over D ≤ 1.
        for albedo in ALBEDOS {
            for r in ratios() {
                let means = [1.0 - r, albedo * r];
                let squares = |rule: ParticleRule| {
                    let Kernel { straight, scattered, .. } =
                        rule.probabilities(r, albedo).kernel(1.0, means, 2);
                    [straight, scattered]
                };
                let adaptive = squares(ParticleRule::Adaptive);
                let other = squares(ParticleRule::NonTerminating);
                assert!(adaptive[0] >= other[0] - 1e-15 && adaptive[1] >= other[1] - 1e-15);
            }
        }
    }

    #[test]
    fn nothing_is_left_at_ratio_one_without_albedo() {
        let probabilities = ParticleRule::NonTerminating.probabilities(1.0, 0.0);
        assert_eq!((probabilities.transmit, probabilities.scatter), (0.0, 0.0));
        assert_eq!(probabilities.decide(0.0), Event::Absorbed);
    }

    #[test]
    fn moments_of_rare_scattering_keep_their_digits() {
        // a|r| is 1e-12: computed as a difference from |1 − r|/D it would have few digits.
        let (albedo, r) = (1e-12, 1.25);
        let probabilities = ParticleRule::NonTerminating.probabilities(r, albedo);
        let sum = albedo * r + (r - 1.0);
        for k in 1..5 {
            let result = probabilities.kernel(1.0, [1.0 - r, albedo * r], k).scattered;
            let exact = albedo * r * sum.powi(k - 1);
            assert!((result / exact - 1.0).abs() < 1e-14, "{k}: {result:e} for {exact:e}");
        }
    }

    #[test]
    fn a_number_decides() {
        let probabilities = ParticleRule::Terminating.probabilities(0.5, 0.4);
        assert_eq!(probabilities.decide(0.199), Event::Scattered);
        assert_eq!(probabilities.decide(0.201), Event::Transmitted);
        assert_eq!(probabilities.decide(0.701), Event::Absorbed);
        // A particle that does not terminate is never absorbed.
        let probabilities = ParticleRule::NonTerminating.probabilities(0.37, 0.83);
        assert_eq!(probabilities.decide(1.0 - f64::EPSILON / 2.0), Event::Transmitted);
    }
}

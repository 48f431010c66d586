//! Rules of the particle models at a tentative collision.
//!
//! With `r = (σ_t − σ_c)/σ̂` the transmitted particle keeps the factor `1 − r` on average. The double particle
//! model applies it as a weight. The single particle model uses a part of it as the probability `q_tran` that the
//! particle goes on.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! sections 3.1–3.3, Eqs. 7–12 and `SimulateParticle`.

use super::{Outcome, Rule};
use numeric::Lane;

/// Extinctions at a tentative collision.
#[derive(Debug, Clone, Copy)]
pub struct Extinctions<L> {
    /// `σ_t − σ_c`.
    pub residual: L,
    /// `σ̂`.
    pub sampling: L,
    /// `1/σ̂`.
    pub mean_free_path: L,
}

impl<L: Lane> Extinctions<L> {
    /// `r = (σ_t − σ_c)/σ̂`.
    #[inline(always)]
    pub fn ratio(&self) -> L {
        self.residual * self.mean_free_path
    }
}

/// A rule as one formula for every lane type, common to theory and kernels.
pub trait Collision: Rule + Copy + 'static {
    /// True if a random number decides: then every step of a walk takes a number for it.
    const DECIDES: bool;

    /// True if a survivor's weight changes.
    const WEIGHS: bool = true;

    /// See [`Rule::kinks`].
    fn jumps(&self) -> Vec<f64>;

    /// Outcome of a collision with ratio r.
    fn at<L: Lane>(&self, ratio: L) -> Outcome<L>;

    /// Returns the lanes with particles that end, given numbers in `[0, 1)`. A particle with the ratio NaN goes on,
    /// so that the draw shows it.
    #[inline(always)]
    fn absorption<L: Lane>(&self, extinctions: &Extinctions<L>, number: L) -> L::Mask {
        self.at(extinctions.ratio()).survival.at_most(number)
    }

    /// `(1 − r)/q`: the factor that makes a survivor unbiased.
    #[inline(always)]
    fn unbiased_weight<L: Lane>(&self, ratio: L, survival: L) -> L {
        (ratio.each(1.0) - ratio) / survival
    }
}

impl<C: Collision> Rule for C {
    #[inline(always)]
    fn outcome(&self, ratio: f64) -> Outcome {
        self.at(ratio)
    }

    fn kinks(&self) -> Vec<f64> {
        self.jumps()
    }
}

/// Always go on, with weight `1 − r`: the double particle model (Eq. 8), ratio tracking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weight;

impl Collision for Weight {
    const DECIDES: bool = false;

    fn jumps(&self) -> Vec<f64> {
        Vec::new()
    }

    #[inline(always)]
    fn at<L: Lane>(&self, ratio: L) -> Outcome<L> {
        let one = ratio.each(1.0);
        Outcome { survival: one, death: ratio.each(0.0), weight: one - ratio, loss: ratio }
    }

    #[inline(always)]
    fn unbiased_weight<L: Lane>(&self, ratio: L, _: L) -> L {
        ratio.each(1.0) - ratio
    }
}

/// Go on with probability `1 − r` and weight 1: Woodcock tracking, for `0 ≤ r ≤ 1`.
///
/// Beyond that range (a forced, biased run) the probability is clamped to `[0, 1]`, as a comparison with a uniform
/// number does in any renderer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Null;

impl Collision for Null {
    const DECIDES: bool = true;
    const WEIGHS: bool = false;

    fn jumps(&self) -> Vec<f64> {
        vec![0.0, 1.0]
    }

    #[inline(always)]
    fn at<L: Lane>(&self, ratio: L) -> Outcome<L> {
        let (zero, one) = (ratio.each(0.0), ratio.each(1.0));
        // NaN stays NaN.
        let survival = zero.or_more(one.or_less(one - ratio));
        let death = zero.or_more(one.or_less(ratio));
        Outcome { survival, death, weight: one, loss: zero }
    }

    /// `(1 − u) σ̂ ≤ σ_t − σ_c`: its left side is computed before the lookup. It is as probable as `u < r`, the
    /// decision of pages without a control.
    #[inline(always)]
    fn absorption<L: Lane>(&self, extinctions: &Extinctions<L>, number: L) -> L::Mask {
        number.times_plus(-extinctions.sampling, extinctions.sampling).at_most(extinctions.residual)
    }

    /// A survivor's q is `1 − r` or, where that is clamped, 1: no division is needed.
    #[inline(always)]
    fn unbiased_weight<L: Lane>(&self, ratio: L, survival: L) -> L {
        let one = ratio.each(1.0);
        one + ((one - ratio) - survival)
    }
}

/// Choice of `q_tran` in the single particle model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Single {
    /// `q = |1 − r|`, weight `sgn(1 − r)`; for `0 ≤ r ≤ 2`.
    Terminating,
    /// `q = min(1, |1 − r|)`; unbiased for every `r`; not in the paper.
    Clamped,
    /// `q = |1 − r| / D`, weight `sgn(1 − r) D`, `D = a|r| + |1 − r|`; unbiased for every `r`
    /// (Eq. 12).
    NonTerminating {
        /// The albedo `a` in `[0, 1]`.
        albedo: f64,
    },
    /// Terminating where `r ≥ 1` and `a r + |1 − r| ≤ 1`, otherwise non-terminating.
    Adaptive {
        /// The albedo `a` in `[0, 1]`.
        albedo: f64,
    },
}

/// Selects each element of an outcome by a mask.
#[inline(always)]
fn select<L: Lane>(mask: L::Mask, yes: Outcome<L>, no: Outcome<L>) -> Outcome<L> {
    Outcome {
        survival: L::select(mask, yes.survival, no.survival),
        death: L::select(mask, yes.death, no.death),
        weight: L::select(mask, yes.weight, no.weight),
        loss: L::select(mask, yes.loss, no.loss),
    }
}

impl Single {
    #[inline(always)]
    fn terminating<L: Lane>(ratio: L) -> Outcome<L> {
        let (zero, one, two) = (ratio.each(0.0), ratio.each(1.0), ratio.each(2.0));
        let below = ratio.at_most(one);
        Outcome {
            // |1 − r| > 1 is no probability: such a case is refused, and a forced run shows the bias.
            survival: (one - ratio).size().or_less(one),
            death: zero.or_more(L::select(below, ratio, two - ratio)),
            weight: L::select(below, one, -one),
            loss: L::select(below, zero, two),
        }
    }

    #[inline(always)]
    fn non_terminating<L: Lane>(ratio: L, albedo: f64) -> Outcome<L> {
        let (zero, one) = (ratio.each(0.0), ratio.each(1.0));
        let transmitted = (one - ratio).size();
        let scattered = ratio.size() * albedo;
        let sum = scattered + transmitted;
        let below = ratio.at_most(one);
        Outcome {
            // At r = 1 and a = 0 the particle keeps no weight, whatever q.
            survival: L::select(sum.at_most(zero), zero, transmitted / sum),
            death: L::select(sum.at_most(zero), one, scattered / sum),
            weight: L::select(below, sum, -sum),
            loss: L::select(below, ratio - scattered, one + sum),
        }
    }
}

impl Collision for Single {
    const DECIDES: bool = true;

    fn jumps(&self) -> Vec<f64> {
        match self {
            Self::Terminating | Self::Clamped => vec![0.0, 1.0, 2.0],
            Self::NonTerminating { .. } => vec![0.0, 1.0],
            Self::Adaptive { albedo } => vec![0.0, 1.0, 2.0 / (1.0 + albedo)],
        }
    }

    #[inline(always)]
    fn at<L: Lane>(&self, ratio: L) -> Outcome<L> {
        let one = ratio.each(1.0);
        match *self {
            Self::Terminating => Self::terminating(ratio),
            Self::Clamped => {
                let terminates = (one - ratio).size().at_most(one);
                select(terminates, Self::terminating(ratio), Weight.at(ratio))
            }
            Self::NonTerminating { albedo } => Self::non_terminating(ratio, albedo),
            Self::Adaptive { albedo } => {
                let sum = ratio * albedo + (one - ratio).size();
                let terminates = one.at_most(ratio) & sum.at_most(one);
                select(terminates, Self::terminating(ratio), Self::non_terminating(ratio, albedo))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_keeps_the_transmitted_share_where_it_is_valid() {
        for step in -40..=60 {
            let r = 0.05 * f64::from(step);
            let mut rules = vec![
                Single::Clamped,
                Single::NonTerminating { albedo: 0.7 },
                Single::Adaptive { albedo: 0.7 },
            ];
            if (0.0..=2.0).contains(&r) {
                rules.push(Single::Terminating);
            }
            for rule in rules {
                let o = rule.outcome(r);
                assert!((0.0..=1.0).contains(&o.survival), "{rule:?} at {r}");
                assert!((o.survival * o.weight - (1.0 - r)).abs() < 1e-14, "{rule:?} at {r}");
                assert!((o.loss - (1.0 - o.weight)).abs() < 1e-14, "{rule:?} at {r}");
                assert!((o.death - (1.0 - o.survival)).abs() < 1e-14, "{rule:?} at {r}");
                let unbiased_weight = (1.0 - r) / o.survival;
                assert!(
                    o.survival == 0.0
                        || (rule.unbiased_weight(r, o.survival) - unbiased_weight).abs() < 1e-14
                );
            }
        }
    }

    #[test]
    fn what_is_due_is_the_share_over_the_chance() {
        for step in -40..20 {
            let r = 0.05 * f64::from(step);
            let (null, weight) = (Null.at(r), Weight.at(r));
            assert!(
                (Null.unbiased_weight(r, null.survival) - (1.0 - r) / null.survival).abs() < 1e-14
            );
            assert_eq!(Weight.unbiased_weight(r, weight.survival), (1.0 - r) / weight.survival);
        }
    }

    #[test]
    fn null_collisions_are_decided_as_their_chance_says() {
        for sampling in [1.0, 0.3, 1e-9, 1e9] {
            let extinctions = |r: f64| Extinctions {
                residual: r * sampling,
                sampling,
                mean_free_path: 1.0 / sampling,
            };
            for step in -40..60 {
                let r = 0.05 * f64::from(step);
                for number in [0.0, 1e-17, 0.33, 0.77, 1.0 - 0.5 * f64::EPSILON] {
                    let killed = number >= Null.at(r).survival;
                    assert_eq!(Null.absorption(&extinctions(r), number), killed, "{r}, {number}");
                }
            }
            // In spite of rounding, nothing survives at r = 1, and nothing ends at r = 0.
            for number in [0.0, 0.1, 1.0 - 0.5 * f64::EPSILON] {
                assert!(
                    Null.absorption(&extinctions(1.0), number)
                        && !Null.absorption(&extinctions(0.0), number)
                );
            }
            assert!(
                !Null.absorption(&extinctions(f64::NAN), 0.0)
                    && Null.absorption(&extinctions(f64::INFINITY), 0.0)
            );
        }
    }

    #[test]
    fn rare_deaths_keep_their_digits() {
        for r in [1e-9, -1e-9, 1e-15] {
            let outcome = Single::NonTerminating { albedo: 0.7 }.outcome(r);
            assert!((outcome.death / (0.7 * r.abs()) - 1.0).abs() < 1e-8, "{r}");
            let death = Single::Terminating.outcome(r).death;
            assert_eq!((death, Null.outcome(r).death), (r.max(0.0), r.max(0.0)));
        }
        assert_eq!(Single::Terminating.outcome(2.0 - 1e-12).death, 2.0 - (2.0 - 1e-12));
    }

    #[test]
    fn zero_albedo_at_ratio_one_is_no_division_by_zero() {
        let outcome = Single::NonTerminating { albedo: 0.0 }.outcome(1.0);
        assert_eq!((outcome.survival, outcome.weight), (0.0, 0.0));
    }
}

//! Walks in space: bounds on the variance of the energy that a particle deposits or carries out.
//!
//! In a furnace the expected score of a particle is its weight w, at any place and in any direction. The energy
//! that it has scored, `Σ w r (1 − a)`, plus the weight that it carries is a martingale. With `Q_k`, `S_k` of a
//! collision, the collision adds the variance `w² v`, and w² itself loses `w² ℓ` on average,
//! ```text
//! v = Q₂ + S₂ − (1 − (1 − a) r)²,   ℓ = 1 − Q₂ − S₂,   Var[X] = E[Σ w² v] ≤ sup v/ℓ     where ℓ > 0
//! ```
//!
//! for `r < 2/(a + 1)`. A rule that never ends a walk has v = 0 for `σ̂ ≥ σ_t`: every draw is 1. Where ℓ ≤ 0 a
//! particle may gain weight faster than it leaves. In a thin volume it still leaves: a flight ends in a collision
//! with probability `p = 1 − exp(−σ̂ d)` at most, d the longest way through, and
//!
//! ```text
//! Var[X] ≤ p sup v/(1 − p sup(Q₂ + S₂))
//! ```
//!
//! Roulette below w₀ adds `w₀ w − w²` each time. Where no weight grows, `U(w) = 2w − w²` is an upper bound of the
//! variance that is still to come, so that `Var[X] ≤ 1`; and `w₀²` where v = 0.
//!
//! Bounds are searched on a grid of r and a and raised by a hundredth. All of it is derived here.

use crate::ParticleRule;

/// Maximum excess of a ratio above 1 that is rounding of a majorant.
const SLACK: f64 = 1e-8;
/// Factor by which the grid's bound is raised.
const RAISED: f64 = 1.01;
/// Maximum variance that is rounding.
const NOTHING: f64 = 1e-13;
/// Steps of the grid in r.
const STEPS: u32 = 2000;

/// Input of a bound.
#[derive(Debug, Clone, Copy)]
pub struct Walks {
    /// Rule at a collision.
    pub rule: ParticleRule,
    /// w₀, where roulette is played.
    pub roulette: Option<f64>,
    /// True if the first collisions split.
    pub splits: bool,
    /// An upper bound of r everywhere.
    pub largest_ratio: f64,
    /// The least and the largest albedo.
    pub albedo: [f64; 2],
    /// A bound on `∫σ̂` along any straight line through the volume.
    pub depth: f64,
}

/// The largest of v, of Q₂ + S₂ and of v/ℓ; the last is infinite where ℓ ≤ 0.
#[derive(Debug, Clone, Copy)]
struct Extremes {
    spread: f64,
    kept: f64,
    relative: f64,
}

impl Walks {
    /// The largest r, without the rounding of a majorant.
    pub fn ratio(&self) -> f64 {
        if self.largest_ratio <= 1.0 + SLACK {
            self.largest_ratio.min(1.0)
        } else {
            self.largest_ratio
        }
    }

    /// Returns true if no weight ever exceeds that at the start.
    pub fn never_grows(&self) -> bool {
        self.ratio() <= 1.0
    }

    /// Returns true if the energy has a bound for any size of the volume: no weight grows, or none faster than
    /// walks end.
    pub fn is_tame(&self) -> bool {
        let limit = 2.0 / (1.0 + self.albedo[1]);
        let settles = self.rule != ParticleRule::Weighted && self.roulette.is_none();
        self.never_grows() || (settles && self.ratio() < limit * (1.0 - SLACK))
    }

    /// A bound on the variance of the energy of a particle; `None` where none is known.
    pub fn energy_variance(&self) -> Option<f64> {
        let extremes = self.extremes();
        if let Some(below) = self.roulette {
            // For one particle of weight w, at most w w₀ or w. The parts that split share the weight of 1, and each
            // adds its own variance and that of roulette.
            let bound = match (extremes.spread <= NOTHING, self.splits) {
                (true, false) => below * below,
                (true, true) => 2.0 * below,
                (false, false) => 1.0,
                (false, true) => 2.0,
            };
            return self.never_grows().then_some(bound);
        }
        if extremes.spread <= NOTHING {
            // Weights that grow lose the digits of a sum that is 1.
            return (extremes.kept <= 1.0 + SLACK).then_some(0.0);
        }
        let chance = -(-self.depth).exp_m1();
        let thin = if chance * extremes.kept < 1.0 {
            chance * extremes.spread / (1.0 - chance * extremes.kept)
        } else {
            f64::INFINITY
        };
        let bound = RAISED * extremes.relative.min(thin);
        bound.is_finite().then_some(bound)
    }

    fn extremes(&self) -> Extremes {
        let mut found = Extremes { spread: 0.0, kept: 0.0, relative: 0.0 };
        let [least, most] = self.albedo;
        let albedos = if least == most { 0..=0 } else { 0..=20 };
        for albedo in albedos.map(|i| least + (most - least) * f64::from(i) / 20.0) {
            for step in 1..=STEPS {
                let ratio = self.ratio() * f64::from(step) / f64::from(STEPS);
                found.add(self.rule, ratio, albedo, self.splits);
            }
        }
        found
    }
}

impl Extremes {
    fn add(&mut self, rule: ParticleRule, ratio: f64, albedo: f64, splits: bool) {
        let odds = rule.odds(ratio, albedo);
        let kept: f64 = odds.moments([1.0 - ratio, albedo * ratio], 2).iter().sum();
        let spread = kept - (1.0 - (1.0 - albedo) * ratio).powi(2);
        let split = (1.0 - ratio).powi(2) + (albedo * ratio).powi(2);
        let most = if splits { kept.max(split) } else { kept };
        self.kept = self.kept.max(most);
        if splits && split > 1.0 {
            self.relative = f64::INFINITY;
        }
        if spread <= NOTHING {
            return;
        }
        self.spread = self.spread.max(spread);
        let lost = 1.0 - kept;
        let relative = if lost > 0.0 { spread / lost } else { f64::INFINITY };
        self.relative = self.relative.max(relative);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walks(rule: ParticleRule, largest_ratio: f64, albedo: f64) -> Walks {
        let (roulette, splits) = (None, false);
        Walks { rule, roulette, splits, largest_ratio, albedo: [albedo; 2], depth: 1e3 }
    }

    #[test]
    fn a_particle_that_never_ends_brings_what_it_began_with() {
        for albedo in [0.0, 0.4, 1.0] {
            let never = walks(ParticleRule::NonTerminating, 1.0 + 1e-9, albedo);
            assert_eq!(never.energy_variance(), Some(0.0));
        }
        // Nothing is absorbed: nothing is random.
        assert_eq!(walks(ParticleRule::Analog, 1.0, 1.0).energy_variance(), Some(0.0));
    }

    #[test]
    fn bounds_are_those_worked_by_hand() {
        // Weighted: v/ℓ = (1 − a)(1 − r)/(1 + a), largest where r vanishes.
        let bound = walks(ParticleRule::Weighted, 1.0, 0.5).energy_variance().expect("bounded");
        assert!(bound <= 1.01 / 3.0 && bound > 0.99 / 3.0, "{bound}");
        // Analog: 1 − (1 − a) r, at most 1.
        let bound = walks(ParticleRule::Analog, 1.0, 0.5).energy_variance().expect("bounded");
        assert!(bound <= 1.01 && bound > 1.0, "{bound}");
        // Terminating without albedo: v = (r − 1)(2 − r), ℓ = 2 − r beyond 1.
        let bound = walks(ParticleRule::Terminating, 1.9, 0.0).energy_variance().expect("bounded");
        assert!(bound >= 1.0, "{bound}");
    }

    #[test]
    fn beyond_the_limit_only_thin_volumes_have_a_bound() {
        let rule = ParticleRule::NonTerminating;
        // 2/(a + 1) = 1.25 for a = 0.6.
        assert!(walks(rule, 1.24, 0.6).energy_variance().is_some());
        let thick = walks(rule, 1.3, 0.6);
        assert_eq!(thick.energy_variance(), None);
        // D = 1.3 · 1.6 − 1 = 1.08: p 1.1664 < 1 and a finite bound for p = 1/2.
        let thin = Walks { depth: std::f64::consts::LN_2, ..thick };
        let expected = 0.5 * (1.1664 - 0.48f64.powi(2)) / (1.0 - 0.5 * 1.1664);
        let bound = thin.energy_variance().expect("bounded");
        assert!((bound / (1.01 * expected) - 1.0).abs() < 1e-9, "{bound}");
    }

    #[test]
    fn what_is_tame_is_bounded() {
        for rule in ParticleRule::ALL {
            for albedo in [0.0, 0.3, 0.9, 1.0] {
                for largest in [0.5, 1.0, 1.05, 1.3, 1.99] {
                    for splits in [false, true] {
                        let walks = Walks { splits, ..walks(rule, largest, albedo) };
                        let bound = walks.energy_variance();
                        assert!(!walks.is_tame() || bound.is_some(), "{walks:?}");
                    }
                }
            }
        }
        assert!(walks(ParticleRule::NonTerminating, 1.2, 0.5).is_tame());
        assert!(!walks(ParticleRule::NonTerminating, 1.4, 0.5).is_tame());
    }

    #[test]
    fn roulette_has_a_bound_where_weights_do_not_grow() {
        let roulette = Some(0.25);
        let never = Walks { roulette, ..walks(ParticleRule::NonTerminating, 1.0, 0.5) };
        assert_eq!(never.energy_variance(), Some(0.0625));
        let weighted = Walks { roulette, ..walks(ParticleRule::Weighted, 1.0, 0.5) };
        assert_eq!(weighted.energy_variance(), Some(1.0));
        let below = Walks { roulette, ..walks(ParticleRule::NonTerminating, 1.2, 0.5) };
        assert_eq!(below.energy_variance(), None);
    }
}

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
//! The suprema over `0 < r ≤ R` and `a₀ ≤ a ≤ a₁` are closed forms. With `m = 1 − (1 − a) r`:
//!
//! ```text
//! rule              r                  Q₂ + S₂                     v                    v/ℓ
//! terminating       ≤ 1                m                           m(1 − m)             m
//!                   > 1                (1 + a)r − 1                Q₂ + S₂ − m²         ↑ in r and a
//! non-terminating   ≤ 1                m²                          0                    0
//!                   > 1                ((1 + a)r − 1)²             4ar(r − 1)           ↑
//! weighted          ≤ 1                1 − (1 − a²)r               (1 − a)²r(1 − r)     (1 − a)(1 − r)/(1 + a)
//!                   > 1                (2r − 1)((1 + a²)r − 1)     (1 + a)²r(r − 1)     ↑
//! ```
//!
//! `analog` is terminating, `adaptive` non-terminating but terminating in `1 ≤ r ≤ 2/(1 + a)`. Q₂ + S₂ grows with r and
//! a beyond r = 1, is 1 in the limit r = 0 and less between. The v of terminating has no stationary point inside, as
//! `∂v/∂a = r(1 − 2m)` and `∂v/∂r = 1 + a + 2(1 − a)m` have no common root; on each edge it is a concave quadratic.
//! All of it is derived here.

use crate::ParticleRule;

/// Maximum excess of a ratio above 1 that is rounding of a majorant.
const SLACK: f64 = 1e-8;
/// Factor for the rounding of a bound.
const RAISED: f64 = 1.0 + 1e-12;
/// Maximum variance that is rounding.
const NOTHING: f64 = 1e-13;

/// Input of a bound.
#[derive(Debug, Clone, Copy)]
pub struct WalkBound {
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

/// Suprema of v, of Q₂ + S₂ and of v/ℓ; the last is infinite where ℓ ≤ 0.
#[derive(Debug, Clone, Copy)]
struct Extremes {
    spread: f64,
    kept: f64,
    relative: f64,
}

impl WalkBound {
    /// The largest r, without the rounding of a majorant.
    pub fn ratio(&self) -> f64 {
        if self.largest_ratio <= 1.0 + SLACK {
            self.largest_ratio.min(1.0)
        } else {
            self.largest_ratio
        }
    }

    /// Returns whether no weight ever exceeds that at the start.
    pub fn never_grows(&self) -> bool {
        self.ratio() <= 1.0
    }

    /// Returns whether the energy has a bound for any size of the volume: no weight grows, or none faster than
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
        let probability = -(-self.depth).exp_m1();
        let thin = if probability * extremes.kept < 1.0 {
            probability * extremes.spread / (1.0 - probability * extremes.kept)
        } else {
            f64::INFINITY
        };
        let bound = RAISED * extremes.relative.min(thin);
        bound.is_finite().then_some(bound)
    }

    fn extremes(&self) -> Extremes {
        let (maximum, high) = (self.ratio(), self.albedo[1]);
        let [mut result, beyond] = [self.within(maximum.min(1.0)), self.beyond(maximum)];
        if maximum >= 1.0 {
            result.spread = result.spread.max(beyond.spread);
            result.kept = result.kept.max(beyond.kept);
            result.relative = result.relative.max(beyond.relative);
        }
        let split = (1.0 - maximum).powi(2) + (high * maximum).powi(2);
        if self.splits && split > 1.0 {
            result.kept = result.kept.max(split);
            result.relative = f64::INFINITY;
        }
        result
    }

    /// Suprema over `0 < r ≤ maximum ≤ 1`.
    fn within(&self, maximum: f64) -> Extremes {
        let low = self.albedo[0];
        let lost = 1.0 - low;
        let [spread, relative] = match self.rule {
            ParticleRule::Terminating | ParticleRule::Analog => {
                let minimum = (1.0 - lost * maximum).max(0.5);
                [minimum * (1.0 - minimum), 1.0]
            }
            ParticleRule::NonTerminating | ParticleRule::Adaptive => [0.0; 2],
            ParticleRule::Weighted => {
                let half = maximum.min(0.5);
                [lost * lost * half * (1.0 - half), lost / (1.0 + low)]
            }
        };
        let relative = if spread <= NOTHING { 0.0 } else { relative };
        Extremes { spread, kept: 1.0, relative }
    }

    /// Suprema over `1 ≤ r ≤ maximum`.
    fn beyond(&self, maximum: f64) -> Extremes {
        let high = self.albedo[1];
        let both = (1.0 + high) * maximum - 1.0;
        let [spread, kept] = match self.rule {
            ParticleRule::Terminating | ParticleRule::Analog => {
                [self.terminating(maximum, f64::INFINITY), both]
            }
            ParticleRule::NonTerminating => [4.0 * high * maximum * (maximum - 1.0), both * both],
            ParticleRule::Adaptive if both <= 1.0 => {
                [self.terminating(maximum, f64::INFINITY), both]
            }
            ParticleRule::Adaptive => {
                let lasting = 4.0 * high * maximum * (maximum - 1.0);
                [lasting.max(self.terminating(maximum, 2.0)), both * both]
            }
            ParticleRule::Weighted => {
                let square = high * high;
                let kept = (2.0 * maximum - 1.0) * ((1.0 + square) * maximum - 1.0);
                [(1.0 + high).powi(2) * maximum * (maximum - 1.0), kept]
            }
        };
        // v/ℓ is largest in the corner.
        let corner = match self.rule {
            ParticleRule::Terminating | ParticleRule::Analog | ParticleRule::Adaptive
                if kept <= 1.0 =>
            {
                spread_of_terminating(maximum, high)
            }
            _ => spread,
        };
        let relative = match 1.0 - kept {
            _ if spread <= NOTHING => 0.0,
            // At r = 1 it is a, also where both vanish.
            _ if maximum == 1.0 => high,
            lost if lost > 0.0 => corner.max(0.0) / lost,
            _ => f64::INFINITY,
        };
        Extremes { spread, kept, relative }
    }

    /// Supremum of v of the terminating rule over `1 ≤ r ≤ maximum`, `(1 + a) r ≤ sum`.
    fn terminating(&self, maximum: f64, sum: f64) -> f64 {
        let [low, high] = self.albedo;
        let mut largest = 0.0f64;
        let mut look = |ratio: f64, albedo: f64| {
            if (1.0..=maximum).contains(&ratio)
                && (low..=high).contains(&albedo)
                && (1.0 + albedo) * ratio <= sum * (1.0 + SLACK)
            {
                largest = largest.max(spread_of_terminating(ratio, albedo));
            }
        };
        for albedo in [low, high] {
            // ∂v/∂r = 0: 1 + a + 2(1 − a)m = 0.
            let lost = 1.0 - albedo;
            let vertex = (1.0 + (1.0 + albedo) / (2.0 * lost)) / lost;
            for ratio in [1.0, maximum, vertex, sum / (1.0 + albedo)] {
                look(ratio, albedo);
            }
        }
        for ratio in [1.0, maximum] {
            // ∂v/∂a = 0: m = 1/2.
            for albedo in [1.0 - 0.5 / ratio, sum / ratio - 1.0] {
                look(ratio, albedo);
            }
        }
        // Where (1 + a) r = 2, v = 1 − m², which is largest at m = 0.
        look(1.5, 1.0 / 3.0);
        largest
    }
}

/// `(1 + a) r − 1 − (1 − (1 − a) r)²`.
fn spread_of_terminating(ratio: f64, albedo: f64) -> f64 {
    (1.0 + albedo) * ratio - 1.0 - (1.0 - (1.0 - albedo) * ratio).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walks(rule: ParticleRule, largest_ratio: f64, albedo: f64) -> WalkBound {
        let (roulette, splits) = (None, false);
        WalkBound { rule, roulette, splits, largest_ratio, albedo: [albedo; 2], depth: 1e3 }
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
        assert!((3.0 * bound - 1.0).abs() < 1e-11, "{bound}");
        // Analog: 1 − (1 − a) r, at most 1.
        let bound = walks(ParticleRule::Analog, 1.0, 0.5).energy_variance().expect("bounded");
        assert!((bound - 1.0).abs() < 1e-11, "{bound}");
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
        let thin = WalkBound { depth: std::f64::consts::LN_2, ..thick };
        let expected = 0.5 * (1.1664 - 0.48f64.powi(2)) / (1.0 - 0.5 * 1.1664);
        let bound = thin.energy_variance().expect("bounded");
        assert!((bound / expected - 1.0).abs() < 1e-9, "{bound}");
    }

    /// The other method searches v, `Q₂ + S₂` and v/ℓ on a grid, by the probabilities themselves.
    #[test]
    fn no_point_of_a_grid_exceeds_the_suprema_and_some_reach_them() {
        let share = |i: u32| f64::from(i) / 400.0;
        let squared = |i: u32| 1.0 - (1.0 - share(i)).powi(4);
        for rule in ParticleRule::ALL {
            for albedo in [[0.0, 1.0], [0.1, 0.4], [0.3, 0.3], [0.9, 0.95], [0.0, 0.0]] {
                for maximum in [0.3, 0.8, 1.0, 1.01, 1.2, 1.5, 1.9] {
                    if maximum > rule.limits(albedo[1])[1] {
                        continue;
                    }
                    let walks = WalkBound { albedo, ..walks(rule, maximum, 0.0) };
                    let result = walks.extremes();
                    let mut seen = [0.0f64; 3];
                    for (i, j) in (1..=400).flat_map(|i| (0..=40).map(move |j| (i, 10 * j))) {
                        let ratio = maximum * if i % 2 == 0 { share(i) } else { squared(i) };
                        let a = albedo[0] + (albedo[1] - albedo[0]) * share(j);
                        let probabilities = rule.probabilities(ratio, a);
                        let kept =
                            probabilities.kernel(1.0, [1.0 - ratio, a * ratio], 2).after(1.0, 1.0);
                        let spread = kept - (1.0 - (1.0 - a) * ratio).powi(2);
                        let relative = match 1.0 - kept {
                            _ if spread <= 1e-11 => 0.0,
                            lost if lost > 0.0 => spread / lost,
                            _ => f64::INFINITY,
                        };
                        for (seen, value) in seen.iter_mut().zip([spread, kept, relative]) {
                            *seen = seen.max(value);
                        }
                    }
                    let bounds = [result.spread, result.kept, result.relative];
                    let context = format!("{walks:?}: {seen:?} for {bounds:?}");
                    for (seen, bound) in seen.into_iter().zip(bounds) {
                        assert!(seen <= bound * (1.0 + 1e-9) + 1e-12, "{context}");
                    }
                    assert!(bounds[0] <= 1.001 * seen[0] + 1e-9, "{context}");
                    assert!(bounds[1] <= 1.02 * seen[1], "{context}");
                    let is_near = bounds[2] <= 1.03 * seen[2] + 1e-9;
                    // An infinite one may begin in a corner.
                    assert!(is_near || bounds[2] == f64::INFINITY, "{context}");
                }
            }
        }
    }

    #[test]
    fn what_is_tame_is_bounded() {
        for rule in ParticleRule::ALL {
            for albedo in [0.0, 0.3, 0.9, 1.0] {
                for largest in [0.5, 1.0, 1.05, 1.3, 1.99] {
                    for splits in [false, true] {
                        let walks = WalkBound { splits, ..walks(rule, largest, albedo) };
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
        let never = WalkBound { roulette, ..walks(ParticleRule::NonTerminating, 1.0, 0.5) };
        assert_eq!(never.energy_variance(), Some(0.0625));
        let weighted = WalkBound { roulette, ..walks(ParticleRule::Weighted, 1.0, 0.5) };
        assert_eq!(weighted.energy_variance(), Some(1.0));
        let below = WalkBound { roulette, ..walks(ParticleRule::NonTerminating, 1.2, 0.5) };
        assert_eq!(below.energy_variance(), None);
    }
}

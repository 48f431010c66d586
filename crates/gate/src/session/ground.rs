//! The grounds on which a quantity is judged.
//!
//! ```text
//! variance   y has mean 0 and variance V, or at most V      `stats::gate`, Catoni's function
//! kurtosis   y has kurtosis κ at most: V is bounded by what the draws before a block show,
//!            V ≤ ȳ²/(1 − t),  t = √(2κ ln(2^e/α₀)/n),  t ≤ ½,  anew at each doubling e = 1, 2, … of n
//! shown      the same with κ = n/200 of the first n draws, once 1,000 of them or more carry the
//!            variance; an assumption, which all draws together must not contradict
//! range      y lies in [a, b]                                `stats::betting`
//! ```
//!
//! The bound on V fails with probability `e^{−nt²/2κ}` at most, for every distribution of that kurtosis (A. Maurer,
//! *A bound on the deviation probability for sums of non-negative random variables*, JIPAM 4 (2003), article 15).
//! α₀, a tenth of the scalar's level, covers all e together; the evidence has the rest. No draws can show that
//! unseen rare events do not carry the variance (Bahadur and Savage 1956). Therefore `shown` is an assumption:
//! draws may pass by it, and the verdict says so, but never fail.

use super::quantity::VarianceBound;
use crate::stats::Powers;
use crate::stats::betting::{Aim, Bets};
use crate::stats::capital::Capital;
use crate::stats::gate::{Design, GateSums};
use crate::stats::verdict::BLOCK;

/// The share of a scalar's level for a bound on its variance.
const PILOT: f64 = 0.1;
/// Number of draws that must carry the variance before it counts as known.
pub(super) const EFFECTIVE: f64 = 1000.0;
/// n/κ for the kurtosis that is then assumed.
const ASSUMED: f64 = 200.0;
/// Number of draws that must carry a variance before stakes and ε are chosen from it.
pub(super) const RELIABLE: f64 = 100.0;
/// Minimum of that number once half of all draws have passed.
pub(super) const FAIRLY_RELIABLE: f64 = 20.0;
/// n ε over the distance from the truth to the farther end of a range, for a pass by bets of three quarters of that
/// distance.
const FINEST: f64 = 12.0;
/// Maximum t.
const WIDEST: f64 = 0.5;

/// A bound on the variance, and the bets that use it.
pub(super) struct OfVariance {
    ground: VarianceBound,
    /// Kurtosis that the bound relies on, once there is one.
    pub(super) kurtosis: Option<f64>,
    design: Option<Design>,
    /// Number of draws at the last bound, and number of bounds.
    bounded: (u64, i32),
    pub(super) capital: Capital,
}

impl OfVariance {
    pub(super) fn new(ground: VarianceBound) -> Self {
        let kurtosis = match ground {
            VarianceBound::Kurtosis(kurtosis) => Some(kurtosis),
            VarianceBound::Variance(_) | VarianceBound::Shown => None,
        };
        let capital = Capital::default();
        Self { ground, kurtosis, design: None, bounded: (0, 0), capital }
    }

    /// V for the next block, from the draws before it; `None` before the first bound. `ln_fail` is the scalar's
    /// ln(1/level).
    pub(super) fn variance(&mut self, past: &Powers, ln_fail: f64) -> Option<f64> {
        let Some(bound) = self.needed(past, ln_fail) else {
            return match self.ground {
                VarianceBound::Variance(variance) => Some(variance),
                _ => self.design.map(|design| design.variance),
            };
        };
        self.bounded = (past.draws(), self.bounded.1 + 1);
        Some(bound)
    }

    /// A new bound, where one is due and can be given.
    fn needed(&mut self, past: &Powers, ln_fail: f64) -> Option<f64> {
        let (before, bounds) = self.bounded;
        let minimum = if self.ground == VarianceBound::Shown { BLOCK } else { 1 };
        if matches!(self.ground, VarianceBound::Variance(_))
            || past.draws() < minimum.max(2 * before)
        {
            return None;
        }
        let n = past.draws() as f64;
        let kurtosis = match self.kurtosis {
            Some(kurtosis) => kurtosis,
            None if past.effective_draws() >= EFFECTIVE => n / ASSUMED,
            None => return None,
        };
        let ln_chance = f64::from(bounds + 1) * std::f64::consts::LN_2 - PILOT.ln() + ln_fail;
        let t = (2.0 * kurtosis * ln_chance / n).sqrt();
        let bound = past.mean_square() / (1.0 - t);
        let is_given = t <= WIDEST && bound > 0.0 && bound.is_finite();
        is_given.then(|| {
            self.kurtosis = Some(kurtosis);
            bound
        })
    }

    /// Bets on a block.
    pub(super) fn absorb(&mut self, y: &[f64], design: Design) {
        self.design = Some(design);
        let mut sums = GateSums::default();
        sums.absorb(y, &design.arguments());
        self.capital.add(&design.gains(sums.totals(), y.len() as f64));
    }

    /// ln of the share of the evidence that remains beside the bound's own probability of an error.
    pub(super) fn ln_share(&self) -> f64 {
        if matches!(self.ground, VarianceBound::Variance(_)) { 0.0 } else { (1.0 - PILOT).ln() }
    }

    /// Returns whether all draws together contradict the assumption about their variance.
    pub(super) fn is_contradicted(&self, all: &Powers) -> bool {
        let assumed = self.kurtosis.unwrap_or(f64::INFINITY);
        self.ground == VarianceBound::Shown
            && !(all.effective_draws() >= EFFECTIVE && all.kurtosis() <= assumed)
    }
}

/// Number of draws that a bound on the variance needs: those of t = ½ at the first bound.
pub(super) fn draws_of_bound(kurtosis: f64, ln_fail: f64) -> f64 {
    2.0 * kurtosis * (std::f64::consts::LN_2 - PILOT.ln() + ln_fail) / (WIDEST * WIDEST)
}

/// A range, and the bets on it.
pub(super) struct OfRange {
    pub(super) range: [f64; 2],
    pub(super) capital: Capital,
}

impl OfRange {
    pub(super) fn new(range: [f64; 2]) -> Self {
        Self { range, capital: Capital::shared(Bets::shares(range)) }
    }

    /// Maximum variance of a distribution of mean 0 in the range: −ab (Bhatia and Davis 2000).
    pub(super) fn widest(&self) -> f64 {
        -self.range[0] * self.range[1]
    }

    /// n ε of the smallest ε that bets can exclude: the range limits the gain from a draw.
    pub(super) fn finest(&self) -> f64 {
        let reach = self.range[1].max(-self.range[0]);
        if reach.is_finite() { FINEST * reach } else { 0.0 }
    }

    /// ln of the evidence for a pass; infinite for a mean that the range makes impossible.
    pub(super) fn ln_pass(&self, tolerance: f64) -> [f64; 2] {
        let [above, below] = self.capital.ln_pass();
        let proved = |end: f64, side: f64| if end < tolerance { f64::INFINITY } else { side };
        [proved(self.range[1], above), proved(-self.range[0], below)]
    }

    /// Estimate of V from the draws, for the choice of stakes.
    pub(super) fn variance(&self, past: &Powers) -> Option<f64> {
        let is_known = past.effective_draws() >= RELIABLE;
        let shown = if is_known { past.mean_square() } else { f64::INFINITY };
        // A very narrow range gives the largest stakes.
        Some(shown.min(self.widest()).max(f64::MIN_POSITIVE)).filter(|v| v.is_finite())
    }

    pub(super) fn absorb(&mut self, y: &[f64], aim: Option<Aim>, floor: f64) {
        self.capital.add(&Bets::new(self.range, aim, floor).gains(y));
    }
}

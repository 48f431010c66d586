//! Capital of bets: over all draws, and from a later block on.
//!
//! ```text
//! E   = Σ_j v_j e^{L_j}                                    against the claim for all draws, Σ v_j = 1
//! E_c = Σ_j v_j Σ_s w_s e^{L_j from block s on} + what has not begun,  w_s = 1/(s(s + 1))
//! ```
//!
//! Both are test martingales where the claim holds for every draw. The second spreads its capital over the blocks
//! from which on the claim may break, so that a change is found after any number of correct blocks. It costs
//! `ln(s(s + 1))` of evidence for a change at block s.
//!
//! Source: J. Shin, A. Ramdas, A. Rinaldo, *E-detectors: a nonparametric framework for sequential change
//! detection*, New England Journal of Statistics in Data Science 2 (2024), section 2; here with weights that add up
//! to 1, so that the probability of a false alarm is bounded over all time.

/// The logarithms of the gains of each bet on some draws.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Gains {
    /// Against a correct mean.
    pub against: Vec<f64>,
    /// Against a mean of +ε or more, and of −ε or less.
    pub pass: [Vec<f64>; 2],
}

/// Capital of bets; blocks are added in their order.
#[derive(Debug, Clone, Default)]
pub struct Capital {
    /// The share of the capital of each bet; empty for equal shares.
    shares: Gains,
    sum: Gains,
    later: Vec<Later>,
    blocks: u64,
}

/// The capital of one bet that is spread over later beginnings.
#[derive(Debug, Clone, Copy)]
struct Later {
    /// `ln Σ_s w_s e^L`.
    ln_sum: f64,
}

/// ln of the mean of `e^x`; NaN if one of them is NaN.
pub fn ln_mean_exp(x: &[f64]) -> f64 {
    let largest = x.iter().fold(f64::NEG_INFINITY, |maximum, &x| maximum.max(x));
    if x.iter().any(|x| x.is_nan()) {
        return f64::NAN;
    }
    if !largest.is_finite() {
        return largest;
    }
    let sum: f64 = x.iter().map(|x| (x - largest).exp()).sum();
    largest + (sum / x.len() as f64).ln()
}

/// `ln(eˣ + eʸ)`.
pub(super) fn ln_add(x: f64, y: f64) -> f64 {
    let (small, large) = if x < y { (x, y) } else { (y, x) };
    if small == f64::NEG_INFINITY { large } else { large + (small - large).exp().ln_1p() }
}

/// `ln Σ v e^x` over bets of the given shares; −∞ without bets.
fn joined(shares: &[f64], x: &[f64]) -> f64 {
    if x.is_empty() {
        return f64::NEG_INFINITY;
    }
    if shares.is_empty() {
        return ln_mean_exp(x);
    }
    let weighted: Vec<f64> = shares.iter().zip(x).map(|(share, x)| share.ln() + x).collect();
    ln_mean_exp(&weighted) + (x.len() as f64).ln()
}

impl Capital {
    /// Capital with these shares of the bets; `against` and each side of `pass` have the sum 1.
    pub fn shared(shares: Gains) -> Self {
        Self { shares, ..Self::default() }
    }

    /// Adds the gains of the next block. The first block sets the number of bets; a side of the pass may begin
    /// later.
    pub fn add(&mut self, gains: &Gains) {
        let none = Later { ln_sum: f64::NEG_INFINITY };
        self.later.resize(gains.against.len(), none);
        let s = self.blocks;
        let ln_weight = -((s * (s + 1)) as f64).ln();
        for (later, gain) in self.later.iter_mut().zip(&gains.against) {
            if s > 0 {
                later.ln_sum = ln_add(later.ln_sum, ln_weight);
            }
            later.ln_sum += gain;
        }
        join(&mut self.sum.against, &gains.against);
        join(&mut self.sum.pass[0], &gains.pass[0]);
        join(&mut self.sum.pass[1], &gains.pass[1]);
        self.blocks += 1;
    }

    /// ln E.
    pub fn ln_e(&self) -> f64 {
        if self.sum.against.is_empty() {
            0.0
        } else {
            joined(&self.shares.against, &self.sum.against)
        }
    }

    /// ln of the evidence against a mean of +ε or more, and of −ε or less; −∞ without bets.
    pub fn ln_pass(&self) -> [f64; 2] {
        [0, 1].map(|side| joined(&self.shares.pass[side], &self.sum.pass[side]))
    }

    /// ln `E_c`.
    pub fn ln_change(&self) -> f64 {
        if self.later.is_empty() {
            return 0.0;
        }
        let sums: Vec<f64> = self.later.iter().map(|later| later.ln_sum).collect();
        ln_add(joined(&self.shares.against, &sums), -(self.blocks as f64).ln())
    }
}

/// Adds gains to sums; missing sums are 0.
fn join(sums: &mut Vec<f64>, gains: &[f64]) {
    sums.resize(sums.len().max(gains.len()), 0.0);
    sums.iter_mut().zip(gains).for_each(|(sum, gain)| *sum += gain);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gains(against: f64) -> Gains {
        Gains { against: vec![against, -against], pass: [vec![], vec![1.0]] }
    }

    #[test]
    fn capital_is_a_mean_of_products() {
        let mut capital = Capital::default();
        capital.add(&gains(1.0));
        capital.add(&gains(2.0));
        assert!((capital.ln_e() - 3f64.cosh().ln()).abs() < 1e-14);
        assert_eq!(capital.ln_pass(), [f64::NEG_INFINITY, 2.0]);
        // One beginning so far, of weight 1/2; the other half is not bet yet.
        assert!((capital.ln_change() - (0.5 * 2f64.cosh() + 0.5).ln()).abs() < 1e-14);
        capital.add(&gains(-1.0));
        let sums = |s: f64| 0.5 * s.exp() + (-1f64).copysign(s).exp() / 6.0;
        let expected = 0.5 * (sums(1.0) + sums(-1.0)) + 1.0 / 3.0;
        assert!((capital.ln_change() - expected.ln()).abs() < 1e-14);
    }

    #[test]
    fn a_change_is_found_although_all_was_well_before() {
        let mut capital = Capital::default();
        let step = |gain: f64| Gains { against: vec![gain], pass: [vec![], vec![]] };
        (0..20).for_each(|_| capital.add(&step(-1.0)));
        (0..20).for_each(|_| capital.add(&step(1.5)));
        let from = |s: i32| if s < 20 { f64::from(10 + s) } else { 1.5 * f64::from(40 - s) };
        let sum: f64 = (1..40).map(|s| from(s).exp() / f64::from(s * (s + 1))).sum();
        assert!((capital.ln_change() - (sum + 1.0 / 40.0).ln()).abs() < 1e-12);
    }

    #[test]
    fn shares_are_weights() {
        let shares = Gains { against: vec![0.75, 0.25], pass: [vec![], vec![1.0]] };
        let mut capital = Capital::shared(shares);
        capital.add(&gains(2.0));
        assert!((capital.ln_e() - (0.75 * 2f64.exp() + 0.25 * (-2f64).exp()).ln()).abs() < 1e-14);
        assert_eq!(capital.ln_pass(), [f64::NEG_INFINITY, 1.0]);
    }

    #[test]
    fn without_gains_there_is_no_evidence() {
        let mut capital = Capital::default();
        for _ in 0..100 {
            capital.add(&gains(0.0));
        }
        assert!(capital.ln_e().abs() < 1e-14 && capital.ln_change().abs() < 1e-12);
    }
}

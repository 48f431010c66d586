//! Evidence on a mean of draws with an estimated variance.
//!
//! ```text
//! y₁ … yₙ   independent draws of mean 0, V the mean of their variances
//! V̂         mean of independent non-negative Y of mean V:   r = E[ΣY²]/(E ΣY)², the relative error of V̂ squared or more
//! L(V)      mean over s = ±1, m = 1, 4, 16 of exp(s Σψ(mλy) − n ln(1 + (mλ)²V/2)),   ψ Catoni's function
//! M(V)      mean over d = 0, .1, .2, .4, .8 of exp((d(1 − V̂/V) − d²/2)/r)
//! E         min over V of M(V)(1 + L(V))/2
//! ```
//!
//! `L` is an e-value for draws of variance `V`, by Catoni's bound. `M` is one for an estimate of `V`: for Y ≥ 0,
//! `E exp(−aY) ≤ 1 − aV + a²E[Y²]/2`, for any distribution. Their product is an e-value at the true `V` if `y` and
//! `Y` are independent, and the minimum over all `V` is not larger than that. So E holds for every distribution of
//! the draws; the one assumption is `r`, a bound on the kurtosis κ of a draw: pairs of draws, Y = (x − x')²/2, have
//! r = (κ + 3)/2 over the number of pairs.
//!
//! Sources: O. Catoni, *Challenging the empirical mean and empirical variance*, AIHP B 48 (2012); A. Maurer, *A
//! bound on the deviation probability for sums of non-negative random variables*, JIPAM 4 (2003), article 15;
//! V. Vovk, R. Wang, *E-values: calibration, combination and applications*, Annals of Statistics 49 (2021).

use super::capital::ln_mean_exp;
use super::catoni::{Argument, PsiSums};
use super::gate::PLANNED;

/// The multiples m of λ.
const SLOPES: [f64; 3] = [1.0, 4.0, 16.0];
/// The stakes d on an estimate that is too low.
const STAKES: [f64; 5] = [0.0, 0.1, 0.2, 0.4, 0.8];
/// The ratio of adjacent values of V, and the largest V in units of V̂.
const STEP: f64 = 1.1;
const LARGEST: f64 = 1e4;
/// Maximum share by which an estimate may be too low and still bound the variance.
const WIDEST: f64 = 0.9;

/// An estimate of a variance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// V̂, above 0.
    pub variance: f64,
    /// r; 0 for a variance that is known exactly.
    pub error: f64,
}

impl Estimate {
    /// Returns ln E of the draws `y`; the means of correct draws deviate by `floor` at most.
    pub fn ln_e(self, y: &[f64], floor: f64) -> f64 {
        let mut gathered = Gathered::new(self, y.len() as f64);
        gathered.absorb(y);
        gathered.ln_e(floor)
    }

    /// Returns a variance that the true one exceeds with probability `level` at most: V̂/(1 − √(2r ln(1/level))).
    /// `None` where the estimate is too uncertain for any.
    pub fn upper(self, level: f64) -> Option<f64> {
        let share = (2.0 * self.error * -level.ln()).sqrt();
        (share <= WIDEST).then(|| self.variance / (1.0 - share))
    }
}

/// Evidence that is gathered from parts of the draws.
#[derive(Debug, Clone)]
pub struct Gathered {
    estimate: Estimate,
    /// n: the number of all draws.
    draws: f64,
    /// λ.
    slope: f64,
    sums: PsiSums<3>,
}

impl Gathered {
    /// Evidence without draws yet; `draws` will come.
    pub fn new(estimate: Estimate, draws: f64) -> Self {
        let slope = (PLANNED / draws).sqrt().min(0.25) / estimate.variance.sqrt();
        Self { estimate, draws, slope, sums: PsiSums::default() }
    }

    /// Adds draws.
    pub fn absorb(&mut self, y: &[f64]) {
        self.sums.absorb(y, &SLOPES.map(|m| Argument { slope: m * self.slope, shift: 0.0 }));
    }

    /// Returns ln E of all draws; the means of correct draws deviate by `floor` at most.
    pub fn ln_e(&self, floor: f64) -> f64 {
        let Estimate { variance, error } = self.estimate;
        let sums = self.sums.totals();
        let of_mean = |excess: f64| {
            let variance = variance * excess + floor * floor;
            let mut gains = [0.0; 6];
            for (i, (m, sum)) in SLOPES.iter().zip(sums).enumerate() {
                let t = m * self.slope;
                let paid = self.draws * ((0.5 * t * t * variance).ln_1p() + t * floor);
                (gains[2 * i], gains[2 * i + 1]) = (sum - paid, -sum - paid);
            }
            ln_mean_exp(&gains)
        };
        if error <= 0.0 {
            return of_mean(1.0);
        }
        let of_variance = |share: f64| {
            let gain = |d: f64| (d * (1.0 - share) - 0.5 * d * d) / error;
            ln_mean_exp(&STAKES.map(gain))
        };
        let joined = |ln_l: f64, ln_m: f64| ln_m + ln_mean_exp(&[0.0, ln_l]);
        // L falls with V and M grows: of each interval the lower of both ends. Below V̂, M is 1/5 or more.
        let mut minimum = joined(of_mean(1.0), -(STAKES.len() as f64).ln());
        let mut excess = 1.0;
        while excess < LARGEST {
            minimum = minimum.min(joined(of_mean(excess * STEP), of_variance(1.0 / excess)));
            excess *= STEP;
        }
        minimum.min(joined(f64::NEG_INFINITY, of_variance(1.0 / excess)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::rng::{Address, unit};

    fn draws(seed: u64, n: usize, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut rng = Address { seed, experiment: 21, block: 0, lane: 0 }.stream();
        (0..n).map(|_| of(unit(&mut rng))).collect()
    }

    /// Half the squared differences of pairs: V̂ and r of exponential draws, κ = 9: r = 6/pairs.
    fn estimated(seed: u64, pairs: usize) -> Estimate {
        let x = draws(seed, 2 * pairs, |u| -(1.0 - u).ln());
        let sum: f64 = x.chunks(2).map(|x| 0.5 * (x[0] - x[1]).powi(2)).sum();
        Estimate { variance: sum / pairs as f64, error: 6.0 / pairs as f64 }
    }

    #[test]
    fn correct_means_keep_the_level_and_wrong_ones_do_not() {
        let (mut high, mut result) = (0, 0);
        for seed in 0..400 {
            let estimate = estimated(1000 + seed, 256);
            let y = |shift: f64| draws(seed, 200, |u| -(1.0 - u).ln() - 1.0 + shift);
            // P(E ≥ 20) ≤ 1/20 by Markov's inequality: 20 of 400 on average at most.
            high += usize::from(estimate.ln_e(&y(0.0), 0.0) >= 20f64.ln());
            // 0.5 √200 = 7 standard errors.
            result += usize::from(estimate.ln_e(&y(0.5), 0.0) >= 20f64.ln());
        }
        assert!(high <= 20 && result >= 380, "{high} {result}");
    }

    #[test]
    fn an_uncertain_estimate_bounds_the_evidence() {
        // With r = 0.1 the variance may be any: M is at most e^{(0.8 − 0.32)/r}.
        let estimate = Estimate { variance: 1.0, error: 0.1 };
        assert!(estimate.ln_e(&[100.0; 50], 0.0) <= 4.8);
        assert!(Estimate { error: 0.0, ..estimate }.ln_e(&[100.0; 50], 0.0) > 100.0);
        // √(0.2 · 2.3) = 0.68.
        let upper = estimate.upper(0.1).expect("a bound");
        assert!((upper - 1.0 / (1.0 - (0.2 * 10f64.ln()).sqrt())).abs() < 1e-12);
        assert_eq!(estimate.upper(1e-3), None);
    }

    #[test]
    fn rounding_is_charged() {
        let exact = Estimate { variance: 1e-6, error: 0.0 };
        assert!(exact.ln_e(&[1e-3; 100], 0.0) > exact.ln_e(&[1e-3; 100], 1e-3));
        assert!(exact.ln_e(&[1e-3; 100], 1e-3) <= 0.0);
    }
}

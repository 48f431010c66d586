//! Distribution of the number of lookups of a draw.

use super::raw::{self, Raw};
use numeric::Known;

/// Maximum mean of a distribution for which probabilities are computed.
pub const LARGEST_MEAN: f64 = 2000.0;
/// Probabilities below this, relative to the largest, are left out.
const FAINT: f64 = 1e-20;
/// Maximum ratio of the variance to the second moment at which the variance is rounding.
const HIDDEN: f64 = 1e-12;

/// Distribution of the number of lookups of one draw.
#[derive(Debug, Clone, PartialEq)]
pub struct CountLaw {
    /// `E[M]`.
    pub mean: f64,
    /// `Var[M]`.
    pub variance: f64,
    /// A relative error bound of the mean beyond rounding.
    pub error: f64,
    /// `μ₄/μ₂²`; 1 where the number is constant.
    pub kurtosis: f64,
    /// True if the distribution is Poisson.
    pub poisson: bool,
    /// `P(M = 0), P(M = 1), …` up to where the rest is below 1e-15; empty where they are unknown,
    /// not requested, or too many because the mean exceeds 2000.
    pub pmf: Vec<f64>,
}

impl CountLaw {
    /// Relative error of a predicted mean number, unless its own `error` is larger.
    pub const ERROR: f64 = 1e-10;

    /// Distribution of a constant.
    pub fn always(number: f64) -> Self {
        let mut pmf = Vec::new();
        if number.fract() == 0.0 && (0.0..=LARGEST_MEAN).contains(&number) {
            Window::default().add(&mut pmf, 1.0, 0.0, whole(number));
        }
        Self { mean: number, variance: 0.0, error: 0.0, kurtosis: 1.0, poisson: false, pmf }
    }

    /// Poisson distribution with the given mean: a walk through `∫σ̂` that nothing ends early.
    pub fn poisson(mean: f64) -> Self {
        let mut pmf = Vec::new();
        if (0.0..=LARGEST_MEAN).contains(&mean) {
            Window::default().add(&mut pmf, 1.0, mean, 0);
        }
        Self { mean, variance: mean, error: 0.0, kurtosis: 3.0 + 1.0 / mean, poisson: true, pmf }
    }

    /// Mean, variance and kurtosis from `E[M(M − 1)…(M − k + 1)]`, k = 1 … 4; no probabilities.
    pub fn of_factorial(factorial: [Known; 4]) -> Self {
        let [mean, ..] = factorial;
        let error = if mean.value > 0.0 { mean.error / mean.value } else { 0.0 };
        Self::of_raw(0.0, raw::of_factorial(factorial.map(|known| known.value)), error)
    }

    /// Mean, variance and kurtosis from the smallest number and the raw moments of the rest, with the relative error
    /// of the mean; no probabilities.
    pub fn of_raw(least: f64, [_, mean, square, cube, fourth]: Raw, error: f64) -> Self {
        let variance = square - mean * mean;
        // A number that is nearly constant has a variance of rounding errors.
        if variance <= HIDDEN * square {
            return Self { error, ..Self::always(least + mean) };
        }
        let fourth = fourth - 4.0 * mean * cube + 6.0 * mean * mean * square - 3.0 * mean.powi(4);
        let kurtosis = (fourth / (variance * variance)).max(1.0);
        Self { mean: least + mean, variance, error, kurtosis, poisson: false, pmf: Vec::new() }
    }
}

/// The Poisson probabilities that are not negligible, by recurrence from the mode outwards.
///
/// ```text
/// P(n) = P(n − 1) m/n,  normalised by their own sum: no factorial, no logarithm, nothing to cancel
/// ```
#[derive(Debug, Default)]
pub struct Window {
    above: Vec<f64>,
    below: Vec<f64>,
}

impl Window {
    /// Adds `weight · P(N = n)` of a Poisson number of the given mean to `pmf[n + shift]`.
    pub fn add(&mut self, pmf: &mut Vec<f64>, weight: f64, mean: f64, shift: usize) {
        let mode = whole(mean);
        self.above.clear();
        self.below.clear();
        let (mut n, mut p) = (mean.floor(), 1.0);
        while p > FAINT {
            self.above.push(p);
            n += 1.0;
            p *= mean / n;
        }
        (n, p) = (mean.floor(), 1.0);
        while n > 0.0 {
            p *= n / mean;
            n -= 1.0;
            if p <= FAINT {
                break;
            }
            self.below.push(p);
        }
        let scale = weight / (self.above.iter().sum::<f64>() + self.below.iter().sum::<f64>());
        let most = shift + mode + self.above.len();
        if pmf.len() < most {
            pmf.resize(most, 0.0);
        }
        let (low, high) = pmf.split_at_mut(shift + mode);
        high.iter_mut().zip(&self.above).for_each(|(sum, p)| *sum += scale * p);
        low.iter_mut().rev().zip(&self.below).for_each(|(sum, p)| *sum += scale * p);
    }
}

/// The floor of a number that is checked to be small and not negative.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn whole(x: f64) -> usize {
    x as usize
}

/// `P(N = n)` for a Poisson number `N` of the given mean.
///
/// ```text
/// P = e^{−m} mⁿ / n!
/// ```
pub fn poisson(n: u32, mean: f64) -> f64 {
    if mean == 0.0 {
        return if n == 0 { 1.0 } else { 0.0 };
    }
    let n = f64::from(n);
    (n * mean.ln() - mean - libm::lgamma(n + 1.0)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poisson_probabilities_sum_to_one() {
        for mean in [0.0, 0.3, 8.0, 200.0] {
            let total: f64 = (0..2000).map(|n| poisson(n, mean)).sum();
            assert!((total - 1.0).abs() < 1e-12, "{mean}: {total}");
        }
    }

    #[test]
    fn rare_lookups_keep_their_digits() {
        // 3 and, once in a thousand millions, one more.
        let law = CountLaw::of_raw(3.0, [1.0, 1e-9, 1e-9, 1e-9, 1e-9], 0.0);
        assert_eq!(law.mean, 3.000_000_001);
        assert!((law.variance / 1e-9 - 1.0).abs() < 2e-9 && law.kurtosis > 0.9e9);
    }
}

//! Distribution of the number of lookups of a draw.

use super::raw::{self, Raw};
use numeric::{Grade, Known};

/// Maximum mean of a distribution for which probabilities are computed.
pub const LARGEST_MEAN: f64 = 2000.0;
/// Rounding of a central moment, relative to the sum of its terms' sizes.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Probabilities below this, relative to the largest, are left out.
const FAINT: f64 = 1e-20;
/// Maximum ratio of the variance to the second moment at which the variance is rounding.
const HIDDEN: f64 = 1e-12;

/// Distribution of the number of lookups of one draw.
#[derive(Debug, Clone, PartialEq)]
pub struct CountDistribution {
    /// `E[M]`.
    pub mean: f64,
    /// `Var[M]`.
    pub variance: f64,
    /// A relative error bound of the mean beyond rounding.
    pub error: f64,
    /// Ground of `error`: proven for constants, Poisson numbers with a closed form as mean, and other closed forms.
    pub grade: Grade,
    /// A relative error bound of the variance and of the fourth central moment; infinite where it is not known.
    pub moments_error: f64,
    /// `μ₄/μ₂²`; 1 where the number is constant.
    pub kurtosis: f64,
    /// `P(M = 0), P(M = 1), …` up to where the rest is below 1e-15; empty where they are unknown,
    /// not requested, or too many because the mean exceeds 2000.
    pub pmf: Vec<f64>,
}

impl CountDistribution {
    /// Relative error of a predicted mean number, unless its own `error` is larger.
    pub const ERROR: f64 = 1e-10;

    /// Returns whether the mean is known to 1e-4, as well as the answers of slabs and balls that draws are compared with.
    pub fn is_sharp(&self) -> bool {
        self.error <= 1e-4
    }

    /// Distribution of a constant.
    pub fn always(number: f64) -> Self {
        let mut pmf = Vec::new();
        if number.fract() == 0.0 && (0.0..=LARGEST_MEAN).contains(&number) {
            PoissonWindow::default().add(&mut pmf, 1.0, 0.0, whole(number));
        }
        let [error, moments_error] = [0.0; 2];
        let (mean, variance, kurtosis, grade) = (number, 0.0, 1.0, Grade::Proven);
        Self { mean, variance, error, grade, moments_error, kurtosis, pmf }
    }

    /// Poisson distribution with the given mean: a walk through `∫σ̂` that nothing ends early.
    pub fn poisson(mean: f64) -> Self {
        let is_listed = (0.0..=LARGEST_MEAN).contains(&mean);
        let pmf = if is_listed { poisson(mean) } else { Vec::new() };
        let [error, moments_error] = [0.0; 2];
        let (variance, kurtosis, grade) = (mean, 3.0 + 1.0 / mean, Grade::Proven);
        Self { mean, variance, error, grade, moments_error, kurtosis, pmf }
    }

    /// Mean, variance and kurtosis from `E[M(M − 1)…(M − k + 1)]`, k = 1 … 4; no probabilities.
    ///
    /// Errors of central moments are those of the factorial moments, each times the absolute value of the derivative,
    /// and of rounding:
    ///
    /// ```text
    /// μ₂ = f₂ + m − m²,   μ₄ = f₄ + (6 − 4m) f₃ + (7 − 12m + 6m²) f₂ + m − 4m² + 6m³ − 3m⁴
    /// ```
    pub fn of_factorial(factorial: [Known; 4]) -> Self {
        let [mean, pairs, triples, fours] = factorial.map(|known| known.value);
        let [error, of_pairs, of_triples, of_fours] = factorial.map(|known| known.error);
        let relative = if mean > 0.0 { error / mean } else { 0.0 };
        let distribution =
            Self::of_raw(0.0, raw::of_factorial([mean, pairs, triples, fours]), relative);
        let distribution = Self { grade: factorial[0].grade, ..distribution };
        if distribution.variance <= 0.0 {
            return distribution;
        }
        let of_variance =
            of_pairs + (1.0 - 2.0 * mean).abs() * error + ROUNDING * (pairs + mean + mean * mean);
        let slopes = [6.0 - 4.0 * mean, 7.0 + 6.0 * mean * (mean - 2.0)];
        let slope = 1.0 + mean * (18.0 * mean - 8.0 - 12.0 * mean * mean) - 4.0 * triples
            + 12.0 * pairs * (mean - 1.0);
        let sizes = fours
            + (6.0 + 4.0 * mean) * triples
            + (7.0 + 6.0 * mean * (mean + 2.0)) * pairs
            + mean * (1.0 + mean * (4.0 + mean * (6.0 + 3.0 * mean)));
        let of_fourth = of_fours
            + slopes[0].abs() * of_triples
            + slopes[1].abs() * of_pairs
            + slope.abs() * error
            + ROUNDING * sizes;
        let fourth = distribution.kurtosis * distribution.variance * distribution.variance;
        let moments_error = (of_variance / distribution.variance).max(of_fourth / fourth);
        Self { moments_error, ..distribution }
    }

    /// Mean, variance and kurtosis from the smallest number and the raw moments of the rest, with an estimate
    /// of the relative error of the mean; no probabilities. The raw moment `E[M^k]` has k times the relative error of
    /// `E[M]`.
    pub fn of_raw(minimum: f64, [_, mean, square, cube, fourth]: Raw, error: f64) -> Self {
        let variance = square - mean * mean;
        // A number that is nearly constant has a variance of rounding errors.
        if variance <= HIDDEN * square {
            return Self { error, grade: Grade::Estimated, ..Self::always(minimum + mean) };
        }
        let relative = error * (minimum + mean) / mean;
        let of_variance =
            2.0 * relative * (square + mean * mean) + ROUNDING * (square + mean * mean);
        let (cubes, squares, last) =
            (4.0 * mean * cube, 6.0 * mean * mean * square, 3.0 * mean.powi(4));
        let of_fourth = 4.0 * relative * (fourth + cubes + squares + last)
            + ROUNDING * (fourth + cubes + squares + last);
        let fourth = (fourth - cubes + squares - last).max(variance * variance);
        let kurtosis = fourth / (variance * variance);
        let moments_error = (of_variance / variance).max(of_fourth / fourth);
        let (mean, grade, pmf) = (minimum + mean, Grade::Estimated, Vec::new());
        Self { mean, variance, error, grade, moments_error, kurtosis, pmf }
    }
}

/// `P(N = 0), P(N = 1), …` of a Poisson number N of the given mean, up to where they are negligible.
pub fn poisson(mean: f64) -> Vec<f64> {
    let mut pmf = Vec::new();
    PoissonWindow::default().add(&mut pmf, 1.0, mean, 0);
    pmf
}

/// The Poisson probabilities that are not negligible, by recurrence from the mode outwards.
///
/// ```text
/// P(n) = P(n − 1) m/n,  normalised by their own sum: no factorial, no logarithm, nothing to cancel
/// ```
#[derive(Debug, Default)]
pub struct PoissonWindow {
    above: Vec<f64>,
    below: Vec<f64>,
}

impl PoissonWindow {
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
        let maximum = shift + mode + self.above.len();
        if pmf.len() < maximum {
            pmf.resize(maximum, 0.0);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rare_lookups_keep_their_digits() {
        // 3 and, once in a thousand millions, one more.
        let distribution = CountDistribution::of_raw(3.0, [1.0, 1e-9, 1e-9, 1e-9, 1e-9], 0.0);
        assert_eq!(distribution.mean, 3.000_000_001);
        assert!((distribution.variance / 1e-9 - 1.0).abs() < 2e-9 && distribution.kurtosis > 0.9e9);
    }
}

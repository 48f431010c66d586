//! Raw moments: of counts, and of draws with their errors.
//!
//! Central moments and tails of all draws come from here:
//!
//! ```text
//! r_k = E[X^k]/m^k,  e_k its error,  δ that of the mean m in units of m
//! μ₂/m² = r₂ − 1              ± e₂ + 2δ
//! μ₃/m³ = r₃ − 3r₂ + 2
//! μ₄/m⁴ = r₄ − 4r₃ + 6r₂ − 3  ± e₄ + 4e₃ + 6e₂ + 4|1 + μ₃/m³|δ
//! ```

use super::moments::not_negative;
use crate::{Channel, Moments, Tails};
use numeric::Known;
use std::ops::{Add, Mul};

/// `E[N^k]`, k = 0 … 4.
pub type Raw = [f64; 5];
/// Highest power of a draw with a computed mean.
pub const HIGHEST: usize = 8;
/// `E[X^k]`, k = 0 … 8.
pub type Powers = [f64; HIGHEST + 1];

/// `n over k`.
pub fn binomial(n: usize, k: usize) -> f64 {
    (1..=k).fold(1.0, |product, i| product * (n + 1 - i) as f64 / i as f64)
}

/// `x^k`.
pub fn power(x: f64, k: usize) -> f64 {
    x.powi(i32::try_from(k).unwrap_or(i32::MAX))
}

/// Raw moments of a Poisson number of mean m.
pub fn poisson(m: f64) -> Raw {
    [1.0, m, m * (1.0 + m), m * (1.0 + m * (3.0 + m)), m * (1.0 + m * (7.0 + m * (6.0 + m)))]
}

/// Raw moments of the sum of two independent numbers.
pub fn added<T, const N: usize>(a: [T; N], b: [T; N]) -> [T; N]
where
    T: Copy + Add<Output = T> + Mul<Output = T> + Mul<f64, Output = T>,
{
    let term = |k: usize, j: usize| a[k - j] * binomial(k, j) * b[j];
    std::array::from_fn(|k| (1..=k).fold(term(k, 0), |sum, j| sum + term(k, j)))
}

/// Raw moments from `E[N(N − 1)…(N − k + 1)]`, k = 1 … 4.
pub fn of_factorial([f1, f2, f3, f4]: [f64; 4]) -> Raw {
    [1.0, f1, f2 + f1, f3 + 3.0 * f2 + f1, f4 + 6.0 * f3 + 7.0 * f2 + f1]
}

/// Raw moments from the cumulants of orders 1 to 4.
pub fn of_cumulants([k1, k2, k3, k4]: [f64; 4]) -> Raw {
    let second = k2 + k1 * k1;
    let third = k3 + 3.0 * k2 * k1 + k1.powi(3);
    let fourth = k4 + 4.0 * k3 * k1 + 3.0 * k2 * k2 + 6.0 * k2 * k1 * k1 + k1.powi(4);
    [1.0, k1, second, third, fourth]
}

/// Powers of a draw with computed means: those of its moments, and the eighth for its tails.
pub const POWERS: [i32; 5] = [1, 2, 3, 4, 8];
/// One number for each of [`POWERS`].
pub type PerPower = [f64; POWERS.len()];
/// Maximum relative error of a higher moment that is given, unless a solver sets another limit.
pub const RESOLVED: f64 = 0.05;
/// Maximum size of moments, in units of the expected value, that are rounding.
const FAINT: f64 = 1e-9;
/// Rounding error of a difference, in units of ε times the sum of its terms.
const OF_DIFFERENCE: f64 = 8.0;

/// `E[X^k]` of a draw for [`POWERS`], infinite where it diverges or is not computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RawMoments(pub [Known; POWERS.len()]);

impl RawMoments {
    /// Raw moments by their powers; `None` where one is not known.
    pub fn of(power: impl FnMut(i32) -> Option<Known>) -> Option<Self> {
        let result: Vec<Known> = POWERS.into_iter().map(power).collect::<Option<_>>()?;
        result.try_into().ok().map(Self)
    }

    /// Raw moments with estimates of their relative errors.
    pub fn estimated(values: PerPower, errors: PerPower) -> Self {
        let known = |i: usize| Known::estimated(values[i], errors[i] * values[i].abs());
        Self(std::array::from_fn(known))
    }

    /// Raw moments of the sum of two independent draws, without the eighth.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        let of = |Self([one, two, three, four, _]): &Self| {
            [Known::new(1.0, 0.0), *one, *two, *three, *four]
        };
        let [_, one, two, three, four] = added(of(self), of(other));
        Self([one, two, three, four, Known::UNKNOWN])
    }

    /// Raw moments of a draw that is one of two with probability ½ each, and twice its score.
    #[must_use]
    pub fn either(&self, other: &Self) -> Self {
        let half = |i: usize| (self.0[i] + other.0[i]) * 2f64.powi(POWERS[i] - 1);
        Self(std::array::from_fn(half))
    }

    /// Raw moments in units of powers of a mean that has the same resolution: the k-th has 1 + k times the error.
    #[must_use]
    pub fn in_units_of_their_mean(&self) -> Self {
        let widened = |i: usize| {
            let known = self.0[i];
            Known { error: f64::from(1 + POWERS[i]) * known.error, ..known }
        };
        Self(std::array::from_fn(widened))
    }

    /// Returns whether the draw is its mean with no rounding at all.
    pub fn is_certain(&self, mean: f64) -> bool {
        [1, 2, 3].into_iter().all(|i| self.0[i].value == mean.powi(POWERS[i]))
    }

    /// `E[X²]`.
    pub fn second(&self) -> Known {
        self.0[1]
    }

    /// Central moments around the mean. Higher ones are infinite where their relative error exceeds a limit, as where
    /// they diverge.
    pub fn central(&self, mean: Known, limit: f64) -> Moments {
        let m = mean.value;
        let blur = mean.error / m.abs();
        let [_, second, third, fourth, _] = self.0;
        let grade = mean.grade.min(second.grade);
        let unit = |known: Known, k: i32| [known.value / m.powi(k), known.error / m.powi(k).abs()];
        let [[a, e2], [b, e3], [c, e4]] = [unit(second, 2), unit(third, 3), unit(fourth, 4)];
        let rounding = |terms: f64| OF_DIFFERENCE * f64::EPSILON * terms;
        let [variance, error] = not_negative(a - 1.0, e2 + 2.0 * blur + rounding(a + 1.0));
        let skew = b - 3.0 * a + 2.0;
        let off = e4 + 4.0 * e3 + 6.0 * e2 + 4.0 * (1.0 + skew).abs() * blur;
        let off = off + rounding(c + 4.0 * b.abs() + 6.0 * a + 3.0);
        let result = c - 4.0 * b + 6.0 * a - 3.0;
        let [peak, of_peak] = not_negative(result.max(variance * variance), off);
        // By Jensen's inequality the fourth moment is at least the square of the second.
        let is_possible = result >= (1.0 - limit) * variance * variance - FAINT;
        if !(c.is_finite() && b.is_finite() && of_peak < limit && is_possible) {
            let relative = [variance, f64::INFINITY, f64::INFINITY];
            return Moments { scale: m, relative, error, grade };
        }
        let grade = grade.min(third.grade).min(fourth.grade);
        Moments { scale: m, relative: [variance, skew, peak], error: error.max(of_peak), grade }
    }

    /// Heaviness of the tails, infinite where moments have larger relative errors than a limit. The rare-event size is
    /// that of `D ≤ ln(E[X⁴]/E[X²]²)`, by Jensen's inequality.
    pub fn tails(&self, limit: f64) -> Tails {
        let [_, two, _, fourth, eighth] = self.0;
        let two = two.value;
        let or_infinite = |Known { value, error, .. }: Known, minimum: f64| {
            let is_resolved = error <= limit * value && value >= (1.0 - limit) * minimum;
            if is_resolved { value } else { f64::INFINITY }
        };
        let four = or_infinite(fourth, two * two);
        let eight = or_infinite(eighth, four * four);
        let ratio = if eight.is_finite() { eight / (four * four) } else { f64::INFINITY };
        Tails { rare_event_size: four / (two * two), eighth_moment_ratio: ratio }
    }

    /// An unbiased channel with these moments.
    pub fn channel(&self, truth: Known, limit: f64) -> Channel {
        Channel::unbiased(truth, self.central(truth, limit), self.tails(limit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::Grade;

    #[test]
    fn moments_of_a_poisson_number_add_like_means() {
        let sum = added(poisson(0.7), poisson(1.9));
        for (a, b) in sum.iter().zip(poisson(2.6)) {
            assert!((a - b).abs() < 1e-13 * b);
        }
    }

    #[test]
    fn an_error_of_the_mean_moves_central_moments_by_less_than_is_stated() {
        // A draw of 0, 1 or 3, and a mean that is off by 1e-6.
        let raw = RawMoments(POWERS.map(|k| Known::new(0.3 + 0.2 * 3f64.powi(k), 0.0)));
        let exact = raw.central(Known::new(0.9, 0.0), 0.5);
        let near = raw.central(Known::new(0.9 + 1e-6, 1.01e-6), 0.5);
        let in_units =
            |moments: Moments, i: usize, k: i32| moments.relative[i] * moments.scale.powi(k);
        for (i, k) in [(0, 2), (2, 4)] {
            let [a, b] = [exact, near].map(|moments| in_units(moments, i, k));
            let off = (a / b - 1.0).abs();
            assert!(off > 1e-8 && off <= near.error, "{k}: {off:e}, {:e}", near.error);
        }
        assert_eq!([exact.grade, near.grade], [Grade::Proven; 2]);
    }
}

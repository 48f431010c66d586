//! Truncated power series, and the numbers in which transport is solved.
//!
//! Every collision of a walk multiplies its weight by the mark `1 + y`. The mean weight is then a series in y. Its
//! coefficients are factorial moments of the number M of collisions:
//!
//! ```text
//! E[(1 + y)^M] = Σ E[M(M − 1)…(M − k + 1)] y^k/k!
//! ```
//!
//! Equations for the mean are solved over series in the same way as over doubles, without differences.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Truncated power series `c₀ + c₁y + … + c_{N−1}y^{N−1}`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet<const N: usize>(pub [f64; N]);

/// A number in which transport is solved: a double, or a series. A double is a series of one term.
pub trait Scalar:
    Copy
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + Div<Output = Self>
{
    /// Number of terms.
    const TERMS: usize;

    /// Makes a number from its coefficients.
    fn of_terms(coefficient: impl Fn(usize) -> f64) -> Self;

    /// Returns a coefficient.
    fn term(self, index: usize) -> f64;

    /// Returns `e^x`.
    #[must_use]
    fn exp(self) -> Self;

    /// Returns `ln x`, x > 0.
    #[must_use]
    fn ln(self) -> Self;

    /// Returns `(1 − e^{−x})/x`.
    #[must_use]
    fn mean_decay(self) -> Self;

    /// Returns `x^k` of a double, or `|x|^k` where k is not a whole number that is constant.
    #[must_use]
    fn power_of(self, x: f64) -> Self {
        let k = self.leading();
        let is_constant = (1..Self::TERMS).all(|index| self.term(index) == 0.0);
        #[allow(clippy::cast_possible_truncation)] // a small whole number
        if is_constant && k == k.round() {
            Self::from(x.powi(k as i32))
        } else if x == 0.0 {
            Self::from(0.0)
        } else {
            (self * x.abs().ln()).exp()
        }
    }

    /// Returns the constant term, by which signs and sizes are judged.
    fn leading(self) -> f64 {
        self.term(0)
    }

    /// Returns the mark `1 + y` of a collision; 1 as a double.
    fn mark() -> Self {
        Self::of_terms(|index| f64::from(u8::from(index < 2)))
    }
}

impl Scalar for f64 {
    const TERMS: usize = 1;

    #[inline]
    fn of_terms(coefficient: impl Fn(usize) -> f64) -> Self {
        coefficient(0)
    }

    #[inline]
    fn term(self, _: usize) -> f64 {
        self
    }

    #[inline]
    fn exp(self) -> Self {
        f64::exp(self)
    }

    #[inline]
    fn ln(self) -> Self {
        f64::ln(self)
    }

    #[inline]
    fn mean_decay(self) -> Self {
        if self.abs() < 1e-9 { 1.0 - 0.5 * self } else { -(-self).exp_m1() / self }
    }
}

impl<const N: usize> Scalar for Jet<N> {
    const TERMS: usize = N;

    #[inline]
    fn of_terms(coefficient: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(coefficient))
    }

    #[inline]
    fn term(self, index: usize) -> f64 {
        self.0[index]
    }

    #[inline]
    fn exp(self) -> Self {
        let mut taylor = [self.0[0].exp(); N];
        for k in 1..N {
            taylor[k] = taylor[k - 1] / k as f64;
        }
        self.composed(taylor)
    }

    #[inline]
    fn ln(self) -> Self {
        let mut taylor = [self.0[0].ln(); N];
        let mut power = -1.0;
        for (k, term) in taylor.iter_mut().enumerate().skip(1) {
            power /= -self.0[0];
            *term = power / k as f64;
        }
        self.composed(taylor)
    }

    #[inline]
    fn mean_decay(self) -> Self {
        let mut factorial = 1.0;
        let mut taylor = powers_of_decay(self.0[0]);
        for (k, integral) in taylor.iter_mut().enumerate().skip(1) {
            factorial *= -(k as f64);
            *integral /= factorial;
        }
        self.composed(taylor)
    }
}

/// Argument from which on the integrals of a decay are computed upwards.
const STEEP: f64 = 2.0;
/// Steps of the downward recurrence before the first integral, enough for arguments below [`STEEP`].
const STEPS: usize = 32;

/// Returns `∫₀¹ tᵏ e^{−xt} dt`, k = 0 … N − 1, for x ≥ 0, by the recurrence that loses no digits there.
///
/// ```text
/// k I_{k−1} = x I_k + e^{−x},   I_0 = (1 − e^{−x})/x
/// ```
fn powers_of_decay<const N: usize>(x: f64) -> [f64; N] {
    let end = (-x).exp();
    let mut result = [x.mean_decay(); N];
    if x > STEEP {
        for k in 1..N {
            result[k] = (k as f64 * result[k - 1] - end) / x;
        }
        return result;
    }
    let mut integral = end / (N + STEPS) as f64;
    for k in (1..N + STEPS).rev() {
        if k < N {
            result[k] = integral;
        }
        integral = (x * integral + end) / k as f64;
    }
    result
}

impl<const N: usize> Jet<N> {
    /// Returns `f(x)` by the Taylor coefficients `f⁽ᵏ⁾(c₀)/k!` of f at the constant term.
    #[inline]
    fn composed(self, taylor: [f64; N]) -> Self {
        let mut rest = self;
        rest.0[0] = 0.0;
        taylor.iter().rev().fold(Self::from(0.0), |sum, &term| sum * rest + Self::from(term))
    }

    #[inline]
    fn each(self, of: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(of))
    }
}

impl<const N: usize> From<f64> for Jet<N> {
    #[inline]
    fn from(constant: f64) -> Self {
        Self(std::array::from_fn(|index| if index == 0 { constant } else { 0.0 }))
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.each(|term| -term)
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| (0..=k).map(|i| self.0[i] * other.0[k - i]).sum()))
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        self.each(|term| term * factor)
    }
}

impl<const N: usize> Div<f64> for Jet<N> {
    type Output = Self;
    #[inline]
    fn div(self, divisor: f64) -> Self {
        self.each(|term| term / divisor)
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    #[inline]
    fn div(self, divisor: Self) -> Self {
        let mut quotient = [0.0; N];
        for k in 0..N {
            let known: f64 = (0..k).map(|i| quotient[i] * divisor.0[k - i]).sum();
            quotient[k] = (self.0[k] - known) / divisor.0[0];
        }
        Self(quotient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_and_quotients_undo_exponentials_and_products() {
        let (a, b) = (Jet([0.7, -1.2, 0.4, 2.5]), Jet([1.9, 0.3, -0.8, 0.1]));
        for (result, exact) in
            [(a.exp().ln(), a), (a * b / b, a), (a.power_of(2.0).ln(), a * 2.0f64.ln())]
        {
            for (result, exact) in result.0.iter().zip(exact.0) {
                assert!((result - exact).abs() < 1e-14, "{result} {exact}");
            }
        }
        assert_eq!([3.0.power_of(-2.0), 0.5.power_of(0.0)], [-8.0, 0.0]);
        // `exp` and `ln` of the system: their last digit differs between machines.
        assert!((0.5.power_of(9.0) - 3.0).abs() < 1e-15);
        assert_eq!(Jet([2.0, 0.0]).power_of(-3.0), Jet([9.0, 0.0]));
    }

    /// Series with known terms: those of `e^{2y}`, and of `(1 − e^{−x})/x` from integrals over [0, 1] by a fine rule.
    #[test]
    fn functions_have_the_series_of_their_derivatives() {
        let exponential = Jet([0.0, 2.0, 0.0, 0.0, 0.0]).exp();
        for (result, exact) in exponential.0.iter().zip([1.0, 2.0, 2.0, 4.0 / 3.0, 2.0 / 3.0]) {
            assert!((result - exact).abs() < 1e-15);
        }
        let rule = crate::quadrature::GaussLegendre::new(48);
        for x in [0.0, 1e-10, 1e-3, 0.7, 1.9, 2.1, 9.0] {
            let result = Jet([x, 1.0, 0.0, 0.0]).mean_decay();
            for (k, factor) in [1.0, -1.0, 0.5, -1.0 / 6.0].into_iter().enumerate() {
                let power = |t: f64| t.powi(i32::try_from(k).expect("few")) * (-x * t).exp();
                let exact = factor * rule.integrate(0.0, 1.0, power);
                assert!(
                    (result.0[k] / exact - 1.0).abs() < 1e-13,
                    "{x}, {k}: {} {exact}",
                    result.0[k]
                );
            }
            assert!((result.0[0] / x.mean_decay() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn products_of_marks_count() {
        let marked = Jet::<5>::mark() * Jet::mark() * Jet::mark() - Jet::from(1.0);
        assert_eq!(marked / 1.0, Jet([0.0, 3.0, 3.0, 1.0, 0.0]));
        assert_eq!(<f64 as Scalar>::mark(), 1.0);
    }
}

//! Numbers of about 32 digits: an unevaluated sum of two doubles.
//!
//! ```text
//! x = high + low,  |low| ≤ ulp(high)/2
//! ```
//!
//! Sums and products are exact pairs (Knuth's sum of two, and the product by a fused multiply-add),
//! renormalised: `+ − ×` to 2⁻¹⁰⁴, `÷` and `√` to 2⁻¹⁰², relative. [`DoubleDouble::exp`] halves its
//! argument nine times before a Taylor series of 12 terms, [`DoubleDouble::ln`] is one Newton step from the
//! platform's; both are good to 1e-30 relative to `1 + |x|`. Nothing that a draw computes is made of these:
//! they are what `trueflight-lab stress` measures doubles against.
//!
//! Sources: T. J. Dekker, *A Floating-Point Technique for Extending the Available Precision*, Numerische
//! Mathematik 18 (1971); Y. Hida, X. S. Li, D. H. Bailey, *Algorithms for Quad-DoubleDouble Precision
//! Floating Point Arithmetic*, 15th IEEE Symposium on Computer Arithmetic (2001).

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use super::Lane;

/// A number of about 32 digits, or a pack of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DoubleDouble<L = f64> {
    /// The number, rounded to a double.
    pub high: L,
    /// Rounding error of `high`: the number less `high`.
    pub low: L,
}

/// The sum of two doubles and its rounding error, exactly.
#[inline(always)]
pub fn two_sum<L: Lane>(a: L, b: L) -> DoubleDouble<L> {
    let high = a + b;
    let moved = high - a;
    DoubleDouble { high, low: (a - (high - moved)) + (b - moved) }
}

/// The sum of two doubles with `|a| ≥ |b|` or `a = 0` and its rounding error, exactly.
#[inline(always)]
fn quick_two_sum<L: Lane>(a: L, b: L) -> DoubleDouble<L> {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// The product of two doubles and its rounding error, exactly but for underflow.
#[inline(always)]
pub fn two_prod<L: Lane>(a: L, b: L) -> DoubleDouble<L> {
    let high = a * b;
    DoubleDouble { high, low: a.times_plus(b, -high) }
}

impl<L: Lane> DoubleDouble<L> {
    /// `self · factor`.
    #[must_use]
    #[inline(always)]
    pub fn times(self, factor: L) -> Self {
        let product = two_prod(self.high, factor);
        quick_two_sum(product.high, product.low + self.low * factor)
    }

    /// `√self` of a positive number: Karp's trick, one Newton step on 1/√x.
    #[must_use]
    #[inline(always)]
    pub fn root(self) -> Self {
        let inverse = self.high.each(1.0) / self.high.root();
        let root = self.high * inverse;
        let left = (self - two_prod(root, root)).high;
        two_sum(root, left * (inverse * 0.5))
    }
}

impl DoubleDouble {
    /// ln 2.
    pub const LN_2: Self = Self { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };
    /// π.
    pub const PI: Self = Self { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };
    /// One.
    pub const ONE: Self = Self { high: 1.0, low: 0.0 };

    /// The product of two doubles.
    pub fn product(a: f64, b: f64) -> Self {
        two_prod(a, b)
    }

    /// The quotient of two doubles.
    pub fn ratio(a: f64, b: f64) -> Self {
        Self::from(a) / Self::from(b)
    }

    /// The nearest double.
    pub fn value(self) -> f64 {
        self.high + self.low
    }

    /// `|self|`.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.high < 0.0 || (self.high == 0.0 && self.low < 0.0) { -self } else { self }
    }

    /// `self · 2^power`, exactly but for overflow and underflow.
    #[must_use]
    pub fn scaled(self, power: i32) -> Self {
        // In two steps, so that the factor itself neither overflows nor underflows.
        let half = power / 2;
        let (a, b) = (2f64.powi(half), 2f64.powi(power - half));
        Self { high: self.high * a * b, low: self.low * a * b }
    }

    /// `self^n`.
    #[must_use]
    pub fn powi(self, n: u32) -> Self {
        (0..n).fold(Self::ONE, |power, _| power * self)
    }

    /// `√self`; 0 for numbers that are not positive.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 { Self::default() } else { self.root() }
    }

    /// `e^self`.
    #[must_use]
    pub fn exp(self) -> Self {
        const HALVINGS: i32 = 9;
        if self.high <= -745.0 || self.high >= 709.7 || self.high.is_nan() {
            return Self::from(self.high.exp());
        }
        let power = (self.high / std::f64::consts::LN_2).round();
        let small = (self - Self::LN_2 * Self::from(power)).scaled(-HALVINGS);
        // expm1 of the small argument, then (1 + x)² − 1 = 2x + x² as often as it was halved.
        let mut term = small;
        let mut sum = small;
        for n in 2..=12 {
            term = term * small / Self::from(f64::from(n));
            sum += term;
        }
        for _ in 0..HALVINGS {
            sum = sum.scaled(1) + sum * sum;
        }
        #[allow(clippy::cast_possible_truncation)] // at most 1074
        (sum + Self::ONE).scaled(power as i32)
    }

    /// `e^self − 1`, without cancellation.
    #[must_use]
    pub fn exp_m1(self) -> Self {
        if self.high.abs() > 0.5 {
            return self.exp() - Self::ONE;
        }
        let (mut term, mut sum) = (self, self);
        for n in 2..=28 {
            term = term * self / Self::from(f64::from(n));
            sum += term;
        }
        sum
    }

    /// `ln self`; not a number below 0.
    #[must_use]
    pub fn ln(self) -> Self {
        let near = self.high.ln();
        if !near.is_finite() {
            return Self::from(near);
        }
        if near.abs() < 0.1 {
            return (self - Self::ONE).ln_1p();
        }
        // y + x e^{−y} − 1, of which the first is good to 16 digits.
        let near = Self::from(near);
        near + (self * (-near).exp() - Self::ONE)
    }

    /// `ln(1 + self)`, without cancellation near 0.
    #[must_use]
    pub fn ln_1p(self) -> Self {
        if self.high.abs() > 0.25 {
            return (self + Self::ONE).ln();
        }
        // 2 artanh(x/(2 + x)).
        let s = self / (self + Self::from(2.0));
        let square = s * s;
        let (mut power, mut sum) = (s, s);
        let mut n = 3.0;
        while power.high.abs() > 1e-34 * sum.high.abs() && n < 120.0 {
            power = power * square;
            sum += power / Self::from(n);
            n += 2.0;
        }
        sum.scaled(1)
    }

    /// `sin self` and `cos self`, in radians, `|self| < 1e6`.
    pub fn sin_cos(self) -> [Self; 2] {
        const HALVINGS: u32 = 6;
        let turns = (self.high / (2.0 * std::f64::consts::PI)).round();
        let reduced = self - Self::PI.scaled(1) * Self::from(turns);
        let small = reduced.scaled(-HALVINGS.cast_signed());
        let square = small * small;
        let (mut sine, mut term) = (small, small);
        // 1 − cos, which keeps its digits when it is doubled.
        let (mut versed, mut even) = (Self::default(), Self::ONE);
        for n in 1..=12_i32 {
            let n = f64::from(n);
            even = -(even * square) / Self::from((2.0 * n - 1.0) * (2.0 * n));
            versed = versed - even;
            term = -(term * square) / Self::from((2.0 * n) * (2.0 * n + 1.0));
            sine += term;
        }
        for _ in 0..HALVINGS {
            let cosine = Self::ONE - versed;
            versed = (sine * sine).scaled(1);
            sine = (sine * cosine).scaled(1);
        }
        [sine, Self::ONE - versed]
    }

    /// `|result − self|/|self|`; the absolute difference where this is 0.
    pub fn relative_error(self, result: f64) -> f64 {
        let off = (Self::from(result) - self).abs().value();
        if self.high == 0.0 { off } else { off / self.high.abs() }
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl<L: Lane> Add for DoubleDouble<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let sum = quick_two_sum(high.high, high.low + low.high);
        quick_two_sum(sum.high, sum.low + low.low)
    }
}

impl<L: Lane> Sub for DoubleDouble<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<L: Lane> Neg for DoubleDouble<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl<L: Lane> Mul for DoubleDouble<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let product = two_prod(self.high, other.high);
        let cross = self.high.times_plus(other.low, self.low * other.high);
        quick_two_sum(product.high, product.low + cross)
    }
}

impl<L: Lane> Div for DoubleDouble<L> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let left = self - other.times(first);
        let second = left.high / other.high;
        let left = left - other.times(second);
        let third = left.high / other.high;
        quick_two_sum(first, second) + Self { high: third, low: third.each(0.0) }
    }
}

/// With a double on either side, as if it were written in 32 digits.
macro_rules! with_doubles {
    ($($Trait:ident::$method:ident),*) => {
        $(
            impl $Trait<f64> for DoubleDouble {
                type Output = Self;
                #[inline]
                fn $method(self, other: f64) -> Self {
                    $Trait::$method(self, Self::from(other))
                }
            }

            impl $Trait<DoubleDouble> for f64 {
                type Output = DoubleDouble;
                #[inline]
                fn $method(self, other: DoubleDouble) -> DoubleDouble {
                    $Trait::$method(DoubleDouble::from(self), other)
                }
            }
        )*
    };
}
with_doubles! { Add::add, Sub::sub, Mul::mul, Div::div }

impl AddAssign<f64> for DoubleDouble {
    #[inline]
    fn add_assign(&mut self, x: f64) {
        let sum = two_sum(self.high, x);
        *self = quick_two_sum(sum.high, sum.low + self.low);
    }
}

impl AddAssign for DoubleDouble {
    #[inline]
    fn add_assign(&mut self, x: Self) {
        *self = *self + x;
    }
}

impl std::iter::Sum for DoubleDouble {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::default(), |sum, term| sum + term)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(result: DoubleDouble, exact: DoubleDouble, tolerance: f64) {
        let off = (result - exact).abs().value();
        assert!(off <= tolerance * exact.high.abs().max(1e-300), "{result:?} {exact:?}: {off:e}");
    }

    #[test]
    fn constants_of_31_digits() {
        // e, e⁻¹⁰, ln 10, √2, sin 1 and cos 1, from tables of 40 digits, as two doubles.
        let e = DoubleDouble { high: std::f64::consts::E, low: 1.445_646_891_729_250_2e-16 };
        near(DoubleDouble::ONE.exp(), e, 1e-30);
        let ln_10 =
            DoubleDouble { high: std::f64::consts::LN_10, low: -2.170_756_223_382_249_4e-16 };
        near(DoubleDouble::from(10.0).ln(), ln_10, 1e-30);
        let root = DoubleDouble { high: std::f64::consts::SQRT_2, low: -9.667_293_313_452_913e-17 };
        near(DoubleDouble::from(2.0).sqrt(), root, 1e-31);
    }

    #[test]
    fn inverse_functions_undo_each_other() {
        for i in 1..200 {
            let x = DoubleDouble::ratio(f64::from(i), 7.0);
            near(x.ln().exp(), x, 1e-29);
            near(x.exp().ln(), x, 1e-29);
            near((x / DoubleDouble::from(3.0)) * DoubleDouble::from(3.0), x, 1e-31);
            near(x.sqrt() * x.sqrt(), x, 1e-31);
            let tiny = x.scaled(-60);
            near(tiny.exp_m1().ln_1p(), tiny, 1e-29);
            near((-x).exp_m1(), (-x).exp() - DoubleDouble::ONE, 1e-29);
            let [sine, cosine] = x.sin_cos();
            near(sine * sine + cosine * cosine, DoubleDouble::ONE, 1e-29);
        }
    }

    #[test]
    fn sine_and_cosine_of_known_angles() {
        let [sine, cosine] = (DoubleDouble::PI / DoubleDouble::from(6.0)).sin_cos();
        near(sine, DoubleDouble::from(0.5), 1e-30);
        near(cosine * cosine, DoubleDouble::from(0.75), 1e-30);
    }

    #[test]
    fn what_cancels_is_kept() {
        let x = DoubleDouble::from(1.0) + DoubleDouble::from(1e-25);
        assert!(((x - DoubleDouble::ONE).value() / 1e-25 - 1.0).abs() < 1e-6);
        assert_eq!(
            two_prod(1.0 + f64::EPSILON, 1.0 + f64::EPSILON).low,
            f64::EPSILON * f64::EPSILON
        );
        assert_eq!(two_sum(1.0, 1e-30).low, 1e-30);
    }

    #[test]
    fn far_arguments_do_as_doubles_do() {
        assert_eq!(DoubleDouble::from(800.0).exp().high, f64::INFINITY);
        assert_eq!(DoubleDouble::from(-800.0).exp().high, 0.0);
        assert!(DoubleDouble::from(-1.0).ln().high.is_nan());
        assert_eq!(DoubleDouble::from(-2.0).abs().high, 2.0);
    }
}

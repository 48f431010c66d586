//! Central moments without cancellation.

use numeric::{Grade, Known};

/// The central moments of one draw, in units of its scale: `μ_k / scale^k` for k = 2, 3, 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// The unit: the true value T for transmittance.
    pub scale: f64,
    /// `μ₂/scale²`, `μ₃/scale³`, `μ₄/scale⁴`; infinite where they overflow.
    pub relative: [f64; 3],
    /// A relative error bound of the moments, `scale^k` times `relative`.
    pub error: f64,
    /// Ground of `error`.
    pub grade: Grade,
}

/// A number that is known to be at least 0 with the error `off`, and its relative error. A number below `off` is
/// replaced by `off`, with a relative error of 100 %: zero would mean that draws do not vary.
pub(super) fn not_negative(value: f64, off: f64) -> [f64; 2] {
    if value.is_nan() || off.is_nan() || off == f64::INFINITY {
        return [value, f64::INFINITY];
    }
    let value = value.max(off);
    [value, if value > 0.0 { off / value } else { 0.0 }]
}

impl Moments {
    /// A draw without variance.
    pub fn certain(scale: f64) -> Self {
        Self { scale, relative: [0.0; 3], error: 0.0, grade: Grade::Proven }
    }

    /// Moments with an estimate of their relative error.
    pub fn estimated(scale: f64, relative: [f64; 3], error: f64) -> Self {
        Self { scale, relative, error, grade: Grade::Estimated }
    }

    /// Moments in a unit that was computed apart from them, with its error added to that of the variance.
    #[must_use]
    pub fn in_units_of(self, unit: Known) -> Self {
        let is_off = unit.error > 0.0 && self.relative[0] != 0.0;
        let off = if is_off { 2.0 * unit.relative_error() } else { 0.0 };
        Self { error: self.error + off, ..self }
    }

    /// Moments with the given ground of their error.
    #[must_use]
    pub fn graded(self, grade: Grade) -> Self {
        Self { grade, ..self }
    }

    /// Moments with an error that has the relative differences to another resolution added.
    #[must_use]
    pub fn compared(self, other: &Self) -> Self {
        let difference =
            |i: usize| ((self.relative[i] - other.relative[i]) / self.relative[i]).abs();
        // NaN where both fourth moments are infinite.
        Self::estimated(self.scale, self.relative, self.error + difference(0).max(difference(2)))
    }

    /// The moments of a product estimator from its loss integrals, without the error of the scale.
    ///
    /// ```text
    /// J_k = ∫ σ̂ E[(1 − W)^k] dt
    /// log E[(X/T)²] = J₂,  log E[(X/T)³] = 3J₂ − J₃,  log E[(X/T)⁴] = 6J₂ − 4J₃ + J₄
    /// u = expm1(J₂), v = expm1(−J₃), z = expm1(J₄), U = (1 + u)³
    /// m₂ = u
    /// m₃ = Uv + u²(3 + u)
    /// m₄ = u²(3 + u(16 + u(15 + u(6 + u)))) + Uv[4u(3 + u(3 + u)) + Uv(6 + v(4 + v))] + e^{6J₂−4J₃} z
    /// ```
    ///
    /// Used where |J₂| and |J₃| are below 1/4, where the powers of `u` are small and nothing
    /// cancels; beyond, the exponentials are subtracted directly. `losses[k − 1]` is J_k, with an estimated `error`.
    pub fn of_product(scale: f64, losses: [f64; 4], error: f64) -> Self {
        let [_, j2, j3, j4] = losses;
        let [m2, m3, m4] = if j2.abs() < 0.25 && j3.abs() < 0.25 {
            near_one(j2, j3, j4)
        } else {
            far_from_one(j2, j3, j4)
        };
        let sensitivity = 6.0 * j2.abs() + 4.0 * j3.abs() + j4.abs();
        Self::estimated(scale, [m2, m3, m4.max(m2 * m2)], error * sensitivity.max(1.0))
    }

    /// `Var[X]`.
    pub fn variance(&self) -> f64 {
        self.scale * self.scale * self.relative[0]
    }

    /// `μ₃/μ₂^{3/2}`; `None` without variance.
    pub fn skewness(&self) -> Option<f64> {
        let [m2, m3, _] = self.relative;
        (m2 > 0.0).then(|| if m2.is_infinite() { f64::INFINITY } else { m3 / m2.powf(1.5) })
    }

    /// `μ₄/μ₂²`, 3 for the normal distribution; infinite where the moments overflow, `None` without variance.
    pub fn kurtosis(&self) -> Option<f64> {
        let [m2, _, m4] = self.relative;
        (m2 > 0.0).then(|| if m4.is_infinite() { f64::INFINITY } else { m4 / (m2 * m2) })
    }

    /// The exact variance of the sample variance of `n` draws, relative to the variance squared.
    ///
    /// ```text
    /// Var[s²]/μ₂² = (μ₄/μ₂² − (n − 3)/(n − 1)) / n
    /// ```
    pub fn spread_of_sample_variance(&self, n: f64) -> Option<f64> {
        self.kurtosis().map(|kurtosis| (kurtosis - (n - 3.0) / (n - 1.0)) / n)
    }
}

/// The polynomials in `u`, `v` and `z`: nothing cancels while they are small.
fn near_one(j2: f64, j3: f64, j4: f64) -> [f64; 3] {
    let (u, v, z) = (j2.exp_m1(), (-j3).exp_m1(), j4.exp_m1());
    let cube = (1.0 + u).powi(3);
    let mixed = 4.0 * u * (3.0 + u * (3.0 + u)) + cube * v * (6.0 + v * (4.0 + v));
    // Where e^{J₄} alone overflows, the product of both exponentials may be finite, or smaller than 1.
    let exponent = 6.0 * j2 - 4.0 * j3;
    let last = if z.is_finite() { exponent.exp() * z } else { (exponent + j4).exp() };
    let m4 = u * u * (3.0 + u * (16.0 + u * (15.0 + u * (6.0 + u)))) + cube * v * mixed + last;
    [u, cube * v + u * u * (3.0 + u), m4]
}

/// The exponentials themselves; infinite where they overflow.
fn far_from_one(j2: f64, j3: f64, j4: f64) -> [f64; 3] {
    let [e2, e3, e4] = [j2, 3.0 * j2 - j3, 6.0 * j2 - 4.0 * j3 + j4].map(f64::exp);
    let m3 = if e3.is_finite() { e3 - 3.0 * e2 + 2.0 } else { f64::INFINITY };
    let m4 = if e4.is_finite() { e4 - 4.0 * e3 + 6.0 * e2 - 3.0 } else { f64::INFINITY };
    [j2.exp_m1(), m3, m4]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_agree() {
        for [j2, j3, j4] in [[0.2, 0.15, 0.12], [0.24, -0.2, 0.19], [0.3, 0.25, 0.3]] {
            let (near, far) = (near_one(j2, j3, j4), far_from_one(j2, j3, j4));
            for (a, b) in near.iter().zip(far) {
                assert!((a - b).abs() < 1e-14, "{near:?} {far:?}");
            }
        }
    }

    #[test]
    fn moments_that_overflow_have_an_infinite_kurtosis() {
        // Exponents J₂, 3J₂ − J₃ and 6J₂ − 4J₃ + J₄ beyond 700, one after the other.
        for losses in [
            [0.0, 130.0, 10.0, 10.0],
            [0.0, 300.0, 100.0, 40.0],
            [0.0, 800.0, 800.0, 800.0],
            [0.0, 1e5, 1e5, 1e6],
            [0.0, 1e5, -1e6, 1e7],
        ] {
            let moments = Moments::of_product(1.0, losses, 0.0);
            assert_eq!(moments.kurtosis(), Some(f64::INFINITY), "{losses:?}");
            assert_eq!(moments.spread_of_sample_variance(1e6), Some(f64::INFINITY));
            assert!(!moments.skewness().expect("spread").is_nan(), "{losses:?}");
            assert!(!moments.variance().is_nan());
        }
        // e^{J₄} alone overflows: J₄ = 710 and 717.6, as of ratio tracking with r = 2900 and r = 39.2.
        for losses in [[0.0, 8.44e-5, 0.2448, 710.0], [0.0, 0.466_665, 18.300_59, 717.665]] {
            let [_, j2, j3, j4] = losses;
            let [_, _, m4] = Moments::of_product(1.0, losses, 0.0).relative;
            assert!((m4.ln() / (6.0 * j2 - 4.0 * j3 + j4) - 1.0).abs() < 1e-15, "{losses:?}: {m4}");
        }
        // Just short of it: 6J₂ = 696.
        let finite = Moments::of_product(1.0, [0.0, 116.0, 0.0, 0.0], 0.0);
        assert!(finite.kurtosis().expect("spread").is_finite());
    }

    #[test]
    fn a_bernoulli_draw_has_its_own_kurtosis() {
        // J_k = τ for every k: X is T-Bernoulli with kurtosis (1 − 3p(1 − p))/(p(1 − p)).
        let p = (-0.1f64).exp();
        let moments = Moments::of_product(p, [0.1; 4], 0.0);
        let exact = (1.0 - 3.0 * p * (1.0 - p)) / (p * (1.0 - p));
        assert!((moments.variance() - p * (1.0 - p)).abs() < 1e-15);
        assert!((moments.kurtosis().expect("spread") / exact - 1.0).abs() < 1e-12);
    }
}

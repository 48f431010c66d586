//! The normal distribution, the excursions of Brownian motion, and sums of symmetric draws.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use statrs::distribution::{ContinuousCDF, Normal};

/// The `z` that a standard normal exceeds with probability `tail`.
pub fn upper_quantile(tail: f64) -> f64 {
    -Normal::standard().inverse_cdf(tail)
}

/// The `z` that a standard normal exceeds in absolute value with probability `level`.
pub fn two_sided(level: f64) -> f64 {
    upper_quantile(0.5 * level)
}

/// The probability that a standard normal exceeds `z`.
pub fn upper_tail(z: f64) -> f64 {
    0.5 * libm::erfc(z * FRAC_1_SQRT_2)
}

/// Number of terms that suffice for either series at `x = 1`, where both converge slowest.
const TERMS: i32 = 8;

/// Tail of the largest excursion of Brownian motion, `P(max_{0≤t≤1} |W(t)| > x)`; 1 for `x ≤ 0`.
///
/// ```text
/// P(max_{0≤t≤1} |W(t)| > x) = 4 Σ_{k≥0} (−1)^k Φ̄((2k+1)x)
///                           = 1 − (4/π) Σ_{k≥0} (−1)^k e^{−(2k+1)²π²/(8x²)}/(2k+1)
/// ```
///
/// Source: W. Feller, *An Introduction to Probability Theory and Its Applications*, volume 2,
/// 2nd edition (1971), section X.5. The first series, by reflection, serves `x ≥ 1`; the second,
/// its theta transform, the rest. Valid for every `x`; relative error 1e-12 while the tail is a
/// normal double (`x ≤ 37`).
pub fn excursion_tail(x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let odd = |k: i32| f64::from(2 * k + 1);
    let sign = |k: i32| if k % 2 == 0 { 1.0 } else { -1.0 };
    if x < 1.0 {
        let rate = PI * PI / (8.0 * x * x);
        let term = |k| sign(k) * (-odd(k).powi(2) * rate).exp() / odd(k);
        return 1.0 - 4.0 / PI * (0..TERMS).map(term).sum::<f64>();
    }
    // 4 Φ̄(z) = 2 erfc(z/√2).
    (0..TERMS).map(|k| sign(k) * 2.0 * libm::erfc(odd(k) * x * FRAC_1_SQRT_2)).sum()
}

/// 1/(4(1 − Φ(√2))), rounded up.
const CONSTANT: f64 = 3.179;

/// Bound on the probability of a sum of draws that are symmetric about 0 at least as large, from Σd and Σd².
///
/// ```text
/// t = Σd/√(Σd²),   P(t ≥ x) ≤ min(e^{−x²/2}, 3.178 (1 − Φ(x)))      for independent symmetric d of any distributions
/// ```
///
/// Given the sizes |d| the signs are independent and equally likely, so that the bound needs no moments and holds for any number of
/// draws. The difference of two independent draws of one distribution is symmetric.
///
/// Sources: W. Hoeffding, JASA 58 (1963); V. Bentkus, D. Dzindzalieta, *A tight Gaussian bound for weighted sums of
/// Rademacher random variables*, Bernoulli 21 (2015), with the constant 1/(4(1 − Φ(√2))).
pub fn p_value_of_symmetric(sum: f64, squares: f64) -> f64 {
    if sum == 0.0 || squares <= 0.0 {
        return 1.0;
    }
    let t = sum.abs() / squares.sqrt();
    (2.0 * (-0.5 * t * t).exp().min(CONSTANT * upper_tail(t))).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_the_tables() {
        assert!((two_sided(0.05) - 1.959_963_984_540_054).abs() < 1e-9);
        assert!((upper_quantile(1e-6) - 4.753_424_308_822_899).abs() < 1e-8);
    }

    #[test]
    fn agrees_with_the_series_at_sixty_digits() {
        for (x, tail) in REFERENCE {
            assert!((excursion_tail(x) / tail - 1.0).abs() < 1e-12, "{x}: {}", excursion_tail(x));
        }
    }

    const REFERENCE: [(f64, f64); 9] = [
        (0.25, 0.999_999_996_593_717_5),
        (0.5, 0.990_843_009_710_239_2),
        (0.999, 0.630_137_545_008_697_9),
        (1.0, 0.629_222_570_200_476_1),
        (1.5, 0.267_215_214_383_061),
        (3.0, 0.005_399_592_126_520_377_4),
        (8.0, 2.488_384_229_708_713_5e-15),
        (20.0, 1.101_449_647_442_493_5e-88),
        (37.0, 2.290_228_489_009_830_8e-299),
    ];

    #[test]
    fn the_two_series_meet() {
        let (below, above) = (excursion_tail(1.0 - f64::EPSILON), excursion_tail(1.0));
        assert!((below - above).abs() < 2e-15, "{below} {above}");
    }

    #[test]
    fn ends_are_certain() {
        assert_eq!(excursion_tail(-1.0), 1.0);
        assert_eq!(excursion_tail(0.0), 1.0);
        assert_eq!(excursion_tail(1e-3), 1.0);
        assert_eq!(excursion_tail(f64::INFINITY), 0.0);
        assert!(excursion_tail(f64::NAN).is_nan());
    }

    #[test]
    fn the_bound_holds_for_equal_sizes_exactly() {
        // 2ⁿ equally likely signs of n draws of size 1: P(|S| = n) = 2^{1−n}.
        for n in 1..60 {
            let p = p_value_of_symmetric(f64::from(n), f64::from(n));
            assert!(p >= 2f64.powi(1 - n), "{n}: {p}");
        }
        // Of 16 draws, P(|S| ≥ 8) = 2 Σ_{k ≤ 4} C(16, k)/2¹⁶ = 2 · 2517/65536.
        let p = p_value_of_symmetric(8.0, 16.0);
        assert!((2.0 * 2517.0 / 65536.0..0.3).contains(&p), "{p}");
        assert_eq!((p_value_of_symmetric(0.0, 1.0), p_value_of_symmetric(0.0, 0.0)), (1.0, 1.0));
        assert!((1.0 / (4.0 * upper_tail(2f64.sqrt()))) < CONSTANT);
    }
}

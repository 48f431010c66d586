//! The largest excursion of Brownian motion.
//!
//! ```text
//! P(max_{0≤t≤1} |W(t)| > x) = 4 Σ_{k≥0} (−1)^k Φ̄((2k+1)x)
//!                           = 1 − (4/π) Σ_{k≥0} (−1)^k e^{−(2k+1)²π²/(8x²)}/(2k+1)
//! ```
//!
//! Source: W. Feller, *An Introduction to Probability Theory and Its Applications*, volume 2,
//! 2nd edition (1971), section X.5. The first series, by reflection, serves `x ≥ 1`; the second,
//! its theta transform, the rest. Valid for every `x`; relative error 1e-12 while the tail is a
//! normal double (`x ≤ 37`).

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Enough terms of either series at `x = 1`, where both are slowest.
const TERMS: i32 = 8;

/// `P(max_{0≤t≤1} |W(t)| > x)`; 1 for `x ≤ 0`.
pub fn upper_tail(x: f64) -> f64 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_series_at_sixty_digits() {
        for (x, tail) in REFERENCE {
            assert!((upper_tail(x) / tail - 1.0).abs() < 1e-12, "{x}: {}", upper_tail(x));
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
        let (below, above) = (upper_tail(1.0 - f64::EPSILON), upper_tail(1.0));
        assert!((below - above).abs() < 2e-15, "{below} {above}");
    }

    #[test]
    fn ends_are_certain() {
        assert_eq!(upper_tail(-1.0), 1.0);
        assert_eq!(upper_tail(0.0), 1.0);
        assert_eq!(upper_tail(1e-3), 1.0);
        assert_eq!(upper_tail(f64::INFINITY), 0.0);
        assert!(upper_tail(f64::NAN).is_nan());
    }
}

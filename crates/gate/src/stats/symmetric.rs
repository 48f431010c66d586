//! The sum of draws that are symmetric about 0, in units of their own size.
//!
//! ```text
//! t = Σd/√(Σd²),   P(t ≥ x) ≤ min(e^{−x²/2}, 3.178 (1 − Φ(x)))      for independent symmetric d of any distributions
//! ```
//!
//! Given the sizes |d| the signs are independent and equally likely, so that the bound needs no moments and holds for any number of
//! draws. The difference of two independent draws of one distribution is symmetric.
//!
//! Sources: W. Hoeffding, JASA 58 (1963); V. Bentkus, D. Dzindzalieta, *A tight Gaussian bound for weighted sums of
//! Rademacher random variables*, Bernoulli 21 (2015), with the constant 1/(4(1 − Φ(√2))).

use super::normal::upper_tail;

/// 1/(4(1 − Φ(√2))), rounded up.
const CONSTANT: f64 = 3.179;

/// Returns a bound on the probability of a |t| at least as large, from Σd and Σd².
pub fn p_value(sum: f64, squares: f64) -> f64 {
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
    fn the_bound_holds_for_equal_sizes_exactly() {
        // 2ⁿ equally likely signs of n draws of size 1: P(|S| = n) = 2^{1−n}.
        for n in 1..60 {
            let p = p_value(f64::from(n), f64::from(n));
            assert!(p >= 2f64.powi(1 - n), "{n}: {p}");
        }
        // Of 16 draws, P(|S| ≥ 8) = 2 Σ_{k ≤ 4} C(16, k)/2¹⁶ = 2 · 2517/65536.
        let p = p_value(8.0, 16.0);
        assert!((2.0 * 2517.0 / 65536.0..0.3).contains(&p), "{p}");
        assert_eq!((p_value(0.0, 1.0), p_value(0.0, 0.0)), (1.0, 1.0));
        assert!((1.0 / (4.0 * upper_tail(2f64.sqrt()))) < CONSTANT);
    }
}

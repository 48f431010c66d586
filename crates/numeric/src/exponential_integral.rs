//! Exponential integrals, which are light of all directions that passes a layer.
//!
//! ```text
//! E_n(x) = ∫₁^∞ e^{−xt}/tⁿ dt = ∫₀¹ e^{−x/μ} μ^{n−2} dμ,   n E_{n+1} = e^{−x} − x E_n
//! ```
//!
//! Source: M. Abramowitz, I. A. Stegun, *Handbook of Mathematical Functions* (1964), 5.1.11 (the series), 5.1.14 and
//! 5.1.22 (the continued fraction).

const EULER: f64 = 0.577_215_664_901_532_9;

/// `E₁` and `E₂` of `x ≥ 0`, to 1e-15 by a series or a continued fraction; 0 and 1 at 0, where `E₁` is infinite.
pub fn exponential_integrals(x: f64) -> [f64; 2] {
    if x <= 0.0 {
        return [0.0, 1.0];
    }
    let decay = (-x).exp();
    let first = if x < 1.5 {
        let (mut sum, mut term) = (-EULER - x.ln(), -1.0);
        for n in 1..26 {
            term *= -x / f64::from(n);
            sum += term / f64::from(n);
        }
        sum
    } else {
        let last = if x < 4.0 { 60 } else { 30 };
        let below = |below: f64, n: i32| {
            let n = f64::from(n);
            x + 2.0 * n - 1.0 - n * n / below
        };
        decay / (1..=last).rev().fold(x + 2.0 * f64::from(last) + 1.0, below)
    };
    [first, decay - x * first]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_the_tables() {
        // Abramowitz and Stegun, table 5.1, E₁(x) at 0.5, 1, 2 and x e^x E₁(x) at 10.
        for (x, table) in [(0.5, 0.559_773_594_8), (1.0, 0.219_383_934_4), (2.0, 0.048_900_510_71)]
        {
            let [first, second] = exponential_integrals(x);
            assert!((first - table).abs() < 6e-11, "{x}: {first}");
            assert!((second - ((-x).exp() - x * first)).abs() < 1e-16);
        }
        let scaled = 10.0 * 10f64.exp() * exponential_integrals(10.0)[0];
        assert!((scaled - 0.915_633_339).abs() < 1e-9, "{scaled}");
        assert_eq!(exponential_integrals(0.0), [0.0, 1.0]);
    }
}

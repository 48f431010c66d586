//! The normal law.

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
    0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_the_tables() {
        assert!((two_sided(0.05) - 1.959_963_984_540_054).abs() < 1e-9);
        assert!((upper_quantile(1e-6) - 4.753_424_308_822_899).abs() < 1e-8);
    }
}

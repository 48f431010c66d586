//! What follows from a variance and a price.

/// The relative standard errors to which times are given.
pub const ERRORS: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// The time until the standard error is `error` of the truth: `V/(ε²T²)` draws.
pub fn time_to(error: f64, variance: f64, truth: f64, seconds_per_draw: f64) -> f64 {
    let deviation = variance.sqrt() / (error * truth);
    deviation * deviation * seconds_per_draw
}

/// `1/(variance · price)`, where both are above 0.
pub fn efficiency(variance: f64, price: f64) -> Option<f64> {
    Some(1.0 / (variance * price)).filter(|efficiency| efficiency.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hand_worked_case() {
        // V = 4, T = 2: a relative error of 1e-2 takes 4/(1e-4 · 4) = 1e4 draws.
        assert!((time_to(1e-2, 4.0, 2.0, 1e-6) - 1e-2).abs() < 1e-16);
        assert_eq!(efficiency(4.0, 0.5), Some(0.5));
        assert_eq!(efficiency(0.0, 1.0), None);
    }

    #[test]
    fn a_tenth_of_the_error_takes_a_hundred_times_the_time() {
        let [first, second, third] = ERRORS.map(|error| time_to(error, 0.3, 0.02, 1e-7));
        assert!((second / first - 100.0).abs() < 1e-9 && (third / second - 100.0).abs() < 1e-9);
    }
}

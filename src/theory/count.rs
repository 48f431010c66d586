//! How many lookups a draw makes.

/// The law of the number of lookups of one draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CountLaw {
    /// `E[M]`.
    pub mean: f64,
    /// `Var[M]`.
    pub variance: f64,
    /// `μ₄/μ₂²`; 1 where the number is always the same.
    pub kurtosis: f64,
    /// Whether the law is Poisson.
    pub poisson: bool,
}

impl CountLaw {
    /// The same number every time.
    #[must_use]
    pub fn always(number: f64) -> Self {
        Self { mean: number, variance: 0.0, kurtosis: 1.0, poisson: false }
    }

    /// Poisson with the given mean: a walk through `∫σ̂` that nothing ends early.
    #[must_use]
    pub fn poisson(mean: f64) -> Self {
        Self { mean, variance: mean, kurtosis: 3.0 + 1.0 / mean, poisson: true }
    }
}

/// `P(N = n)` for a Poisson number `N` of the given mean.
///
/// ```text
/// P = e^{−m} mⁿ / n!
/// ```
#[must_use]
pub fn poisson(n: u32, mean: f64) -> f64 {
    if mean == 0.0 {
        return if n == 0 { 1.0 } else { 0.0 };
    }
    let n = f64::from(n);
    (n * mean.ln() - mean - libm::lgamma(n + 1.0)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poisson_probabilities_sum_to_one() {
        for mean in [0.0, 0.3, 8.0, 200.0] {
            let total: f64 = (0..2000).map(|n| poisson(n, mean)).sum();
            assert!((total - 1.0).abs() < 1e-12, "{mean}: {total}");
        }
    }
}

//! Conditions under which a z may be read as that of a normal distribution.
//!
//! ```text
//! mean of n terms y:  n ≥ 100 E[y⁴]/E[y²]²,  n ≥ 10 n(2)
//! variance:           y = (X − E[X])², with E[X⁸]/E[X⁴]² as heaviness;  √((κ − 1)/n) ≤ 0.1,  (κ − 1) n ≥ 100
//! ```
//!
//! n(2) is the rare-event size: fewer draws do not contain the events that make the variance. A tail that theory does
//! not know counts as too heavy.

/// Largest ratio of moments, as a share of n.
const HEAVY: f64 = 0.01;
/// Number of draws, in units of the rare-event size, that is enough to contain the variance's events.
const SEEN: f64 = 10.0;
/// Largest relative standard error of a variance.
const MAX_VARIANCE_ERROR: f64 = 0.1;
/// Smallest `(κ − 1) n` for which a variance is random enough to have a normal z.
const MIN_EXCESS: f64 = 100.0;

/// Heaviness of the tails of draws; `None` where it is unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tails {
    /// κ.
    pub kurtosis: Option<f64>,
    /// `E[X⁸]/E[X⁴]²`.
    pub eighth_moment_ratio: Option<f64>,
    /// n(2).
    pub rare_event_size: Option<f64>,
}

/// Returns the smallest number of terms with a nearly normal mean, by `E[y⁴]/E[y²]²` and their rare-event size.
pub fn needed(heaviness: f64, rare_event_size: f64) -> f64 {
    (heaviness / HEAVY).max(SEEN * rare_event_size)
}

/// Returns the relative standard error of a sample variance of n draws.
pub fn variance_error(kurtosis: f64, n: f64) -> f64 {
    ((kurtosis - (n - 3.0) / (n - 1.0)).max(0.0) / n).sqrt()
}

impl Tails {
    /// Returns whether the mean of n draws is near normal.
    pub fn has_normal_mean(&self, n: f64) -> bool {
        let known = self.kurtosis.zip(self.rare_event_size);
        known.is_some_and(|(kurtosis, rare)| n >= needed(kurtosis, rare))
    }

    /// Returns whether the sample variance of n draws is near normal.
    pub fn has_normal_variance(&self, n: f64) -> bool {
        let known = self.eighth_moment_ratio.zip(self.rare_event_size);
        let is_near = known.is_some_and(|(eighth, rare)| n >= needed(eighth, rare));
        let is_sharp = self.kurtosis.is_some_and(|kurtosis| {
            variance_error(kurtosis, n) <= MAX_VARIANCE_ERROR && (kurtosis - 1.0) * n >= MIN_EXCESS
        });
        is_near && is_sharp
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_condition_counts() {
        let tails = |kurtosis: f64, eighth: f64, rare: f64| Tails {
            kurtosis: Some(kurtosis),
            eighth_moment_ratio: Some(eighth),
            rare_event_size: Some(rare),
        };
        let n = 1e4;
        let both = |tails: Tails| [tails.has_normal_mean(n), tails.has_normal_variance(n)];
        assert_eq!(both(tails(3.0, 105.0 / 9.0, 3.0)), [true, true], "a normal distribution");
        assert_eq!(both(tails(3.0, 101.0, 3.0)), [true, false]);
        assert_eq!(both(tails(99.0, 99.0, 3.0)), [true, true]);
        // (κ − 1)/n = 1.02e-2: a relative standard error above a tenth.
        assert_eq!(both(tails(103.0, 99.0, 3.0)), [false, false]);
        assert_eq!(both(tails(3.0, 11.0, 1001.0)), [false, false]);
        assert_eq!(both(tails(1.009, 11.0, 1.0)), [true, false], "two values, nearly");
        let unknown = Tails { eighth_moment_ratio: None, ..tails(3.0, 1.0, 1.0) };
        assert_eq!(both(unknown), [true, false]);
        assert_eq!(both(Tails { kurtosis: None, ..unknown }), [false, false]);
    }
}

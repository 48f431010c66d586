//! The variance of the draws against theory, with the predicted fourth moment.
//!
//! ```text
//! z = (v/V − 1)/√((κ − 1)/n),  v = mean of (x − E[X])²
//! ```
//!
//! The predicted mean is known, so v needs no correction for its own. The exact kurtosis κ makes
//! this a test at its level; normal theory would fail correct estimators of high kurtosis most of
//! the time. The normal law
//! holds for it from `n ≥ 100 κ'` on, κ' the kurtosis of the squares that v sums: `E[X⁸]/E[X⁴]²`
//! where tails are heavy. Below that it is inconclusive.

use super::mean::is_certain;
use super::{Check, Comparison, Evidence, Kind, Limits, Subject, rounding};
use crate::harness::record::Finding;
use crate::stats::Tally;
use crate::theory::Channel;

/// The largest relative error of the variance that is still called the same.
const TOLERANCE: f64 = 0.2;
/// A kurtosis this near to 1 makes `(x − E[X])²` constant: nothing is left to test.
const TWO_POINT: f64 = 1.0 + 1e-6;
/// The kurtosis of a squared normal number, 105/9, rounded up: squares are never lighter than that
/// where draws are near normal.
const NORMAL: f64 = 12.0;

/// The check of the variance.
pub struct Variance;

/// Compares the variance with its prediction; `None` where there is nothing to compare.
#[must_use]
pub fn compare(subject: &Subject, channel: &Channel, tally: &Tally) -> Option<Comparison> {
    let moments = channel.moments?;
    let kurtosis = moments.kurtosis().filter(|&kurtosis| kurtosis > TWO_POINT)?;
    if is_certain(subject, channel) || !moments.relative[0].is_finite() {
        return None;
    }
    let unit = moments.scale / channel.truth.value;
    let predicted = moments.relative[0] * unit * unit;
    let observed = tally.mean_square()?;
    let lookups = subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean);
    let noise = rounding(lookups) / predicted.sqrt();
    Some(Comparison {
        difference: observed / predicted - 1.0,
        standard_error: ((kurtosis - 1.0) / tally.draws as f64).sqrt(),
        allowance: moments.error + noise * (2.0 + noise),
        tolerance: subject.tolerance.variance.unwrap_or(TOLERANCE),
        draws_for_level: 100.0 * kurtosis.max(channel.tails.eighth_moment_ratio).max(NORMAL),
    })
}

impl Check for Variance {
    fn kind(&self) -> Kind {
        Kind::Scalar
    }

    fn hypotheses(&self, subject: &Subject) -> usize {
        // A biased experiment is not asked to have the right variance.
        if subject.expect_biased { 0 } else { subject.prediction.channels.len() }
    }

    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding> {
        let channels = subject.prediction.channels.iter().zip(evidence.tallies);
        channels
            .filter_map(|(channel, tally)| {
                let comparison = compare(subject, channel, tally)?;
                let (verdict, reason) = comparison.verdict("the variance", subject, limits);
                let z = Some(comparison.z()).filter(|z| z.is_finite());
                let channel = channel.name.clone();
                Some(Finding { check: "variance".into(), channel, z, p: None, verdict, reason })
            })
            .collect()
    }
}

//! The mean number of lookups against theory.
//!
//! ```text
//! z = (m̄ − E[M])/√(Var[M]/n)
//! ```
//!
//! It sees wrong free flights and wrong endings that the mean hides, and much sooner. A number that
//! theory says is always the same must be met by every draw.

use super::{Check, Comparison, Evidence, Kind, Limits, Subject};
use crate::harness::record::{Finding, Verdict};
use crate::stats::Tally;

/// The largest relative error of the lookups that is still called the same.
const TOLERANCE: f64 = 0.02;

/// The check of the lookups.
pub struct Lookups;

/// Compares the lookups with their prediction; `None` where none is known or all are the same.
#[must_use]
pub fn compare(subject: &Subject, tally: &Tally) -> Option<Comparison> {
    let law = subject.prediction.lookups.as_ref()?;
    let observed = tally.moments()?;
    if law.variance <= 0.0 {
        return None;
    }
    Some(Comparison {
        difference: observed.mean / law.mean,
        standard_error: (law.variance / tally.draws as f64).sqrt() / law.mean,
        allowance: 1e-10,
        tolerance: subject.tolerance.lookups.unwrap_or(TOLERANCE),
        draws_for_level: 100.0 * law.kurtosis,
    })
}

impl Check for Lookups {
    fn kind(&self) -> Kind {
        Kind::Scalar
    }

    fn hypotheses(&self, subject: &Subject) -> usize {
        usize::from(subject.prediction.lookups.is_some())
    }

    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding> {
        let tally = evidence.lookups;
        let finding = |z: Option<f64>, (verdict, reason): (Verdict, String)| {
            let channel = String::new();
            vec![Finding { check: "lookups".into(), channel, z, p: None, verdict, reason }]
        };
        if let Some(comparison) = compare(subject, tally) {
            let z = Some(comparison.z());
            return finding(z, comparison.verdict("the number of lookups", subject, limits));
        }
        let Some(law) = &subject.prediction.lookups else { return Vec::new() };
        // The law's own number may be rounded; a draw that differs by one is far beyond that.
        let rounding = 1e-6 * (1.0 + law.mean) / (1.0 + tally.draws as f64).sqrt();
        let same = tally.mean_square().is_none_or(|square| square.sqrt() <= rounding);
        finding(
            None,
            if same {
                (Verdict::Pass, String::new())
            } else {
                (Verdict::Fail, format!("lookups differ from {} in some draw", law.mean))
            },
        )
    }
}

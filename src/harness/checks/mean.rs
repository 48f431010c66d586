//! The mean of the draws against the exact answer, with the predicted variance.
//!
//! ```text
//! z = (x̄ − truth)/√(V/n)
//! ```
//!
//! V is the variance in theory, not the draws' own: the sample variance of rare events is useless.
//! The normal law holds well enough at the levels in use when `n ≥ 100 κ` (κ the kurtosis) and n is
//! ten times the rare-event size; below that the check is inconclusive. Draws without spread are
//! compared with the truth to rounding. A case that declares an experiment biased passes only if
//! the bias is seen.

use super::{Check, Comparison, Evidence, Kind, Limits, Subject, rounding, too_short};
use crate::harness::record::{Finding, Verdict};
use crate::stats::Tally;
use crate::theory::Channel;

/// The largest relative error of the mean that is still called the same.
const TOLERANCE: f64 = 0.05;

/// The check of the mean.
pub struct Mean;

/// Compares the mean with the truth; `None` without draws.
#[must_use]
pub fn compare(subject: &Subject, channel: &Channel, tally: &Tally) -> Option<Comparison> {
    let observed = tally.moments()?;
    let truth = channel.truth.value;
    // Tallies are in units of the truth, about the predicted mean.
    let difference = observed.mean + (channel.mean.value - truth) / truth;
    let (variance, draws_for_level) = match &channel.moments {
        Some(moments) => {
            let unit = moments.scale / truth;
            let kurtosis = moments.kurtosis().unwrap_or(1.0);
            let level = (100.0 * kurtosis).max(10.0 * channel.tails.rare_event_size);
            (moments.relative[0] * unit * unit, level)
        }
        // A forced experiment has no theory: the draws' own variance must do.
        None => (observed.variance?, 1000.0),
    };
    let lookups = subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean);
    Some(Comparison {
        difference,
        standard_error: (variance / tally.draws as f64).sqrt(),
        allowance: channel.truth.error / truth + rounding(lookups),
        tolerance: subject.tolerance.mean.unwrap_or(TOLERANCE),
        draws_for_level: match (variance > 0.0, channel.moments) {
            (true, _) => draws_for_level,
            (false, Some(_)) => 0.0,
            // Draws that are all the same tell nothing where theory is silent.
            (false, None) => f64::INFINITY,
        },
    })
}

/// Whether the draws have no spread beyond rounding, in theory.
#[must_use]
pub fn is_certain(subject: &Subject, channel: &Channel) -> bool {
    let lookups = subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean);
    channel.moments.is_some_and(|moments| moments.relative[0].sqrt() <= rounding(lookups))
}

impl Check for Mean {
    fn kind(&self) -> Kind {
        Kind::Scalar
    }

    fn hypotheses(&self, subject: &Subject) -> usize {
        subject.prediction.channels.len()
    }

    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding> {
        let channels = subject.prediction.channels.iter().zip(evidence.tallies);
        let judged =
            channels.map(|(channel, tally)| judge_channel(subject, limits, channel, tally));
        let mut findings: Vec<Finding> = judged.collect();
        // A bias somewhere along a curve is a bias; it need not be everywhere.
        let shown = |finding: &Finding| finding.verdict == Verdict::Pass;
        if subject.expect_biased && findings.iter().any(shown) {
            for finding in findings.iter_mut().filter(|finding| !shown(finding)) {
                finding.verdict = Verdict::Pass;
                finding.reason = "biased elsewhere".into();
            }
        }
        findings
    }
}

fn judge_channel(subject: &Subject, limits: &Limits, channel: &Channel, tally: &Tally) -> Finding {
    let comparison = compare(subject, channel, tally);
    let certain = is_certain(subject, channel);
    let z = comparison.filter(|_| !certain).map(|comparison| comparison.z());
    let (verdict, reason) = match comparison {
        _ if tally.not_finite > 0 => {
            (Verdict::Fail, format!("{} draws are not finite numbers", tally.not_finite))
        }
        None => (Verdict::Inconclusive, "nothing was drawn".into()),
        Some(comparison) if subject.expect_biased => biased(subject, limits, comparison, certain),
        Some(comparison) if certain => {
            let spread = tally.mean_square().unwrap_or(0.0).sqrt();
            if spread > 4.0 * comparison.allowance && !biased_by_theory(channel) {
                (Verdict::Fail, format!("draws spread by {spread:.1e} where theory has none"))
            } else if comparison.difference.abs() <= comparison.allowance {
                (Verdict::Pass, String::new())
            } else {
                let bias = 100.0 * comparison.difference;
                (Verdict::Fail, format!("the mean is off by {bias:+.2e} % without any spread"))
            }
        }
        // Draws that all are the truth to rounding are no chance, even where theory is silent.
        Some(comparison) if comparison.standard_error == 0.0 && comparison.is_rounding() => {
            (Verdict::Pass, String::new())
        }
        Some(comparison) => comparison.verdict("the mean", subject, limits),
    };
    let z = z.filter(|z| z.is_finite());
    Finding { check: "mean".into(), channel: channel.name.clone(), z, p: None, verdict, reason }
}

/// Whether theory says that the draws are not the truth on average.
fn biased_by_theory(channel: &Channel) -> bool {
    (channel.mean.value - channel.truth.value).abs() > channel.mean.error + channel.truth.error
}

/// The verdict on an experiment that must show its bias.
fn biased(
    subject: &Subject,
    limits: &Limits,
    comparison: Comparison,
    certain: bool,
) -> (Verdict, String) {
    let bias = format!("{:+.2e} %", 100.0 * comparison.difference);
    let beyond = comparison.difference.abs() - comparison.allowance;
    let shown = beyond > if certain { 0.0 } else { limits.z * comparison.standard_error };
    if shown && subject.draws as f64 >= comparison.draws_for_level {
        (Verdict::Pass, format!("biased-as-expected: {bias}"))
    } else if (subject.draws as f64) < comparison.draws_for_level {
        let needed = comparison.draws_for_level;
        let reason = if needed.is_finite() {
            format!("the bias needs {needed:.1e} draws")
        } else {
            "all draws are the same, which tells nothing here".to_owned()
        };
        (too_short(subject), reason)
    } else {
        (Verdict::Fail, format!("expected a bias, found {bias}"))
    }
}

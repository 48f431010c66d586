//! What the verdicts of an experiment are worth beside each other.

use crate::plan::{Plan, Planned};
use crate::record::{Finding, Verdict};
use gate::session::{self, Reason};

/// What the verdict on a mean is worth, by that on the variance of its channel.
///
/// A mean passes if its variance does, could not be tested, or is that of pilot draws. A mean that is off
/// only in units of a variance that is refuted as too small is not accused: were its spread what the
/// draws show, it would not fail.
pub fn qualify_means(plan: &Plan, planned: &Planned, findings: &mut [Finding]) {
    let variances = findings.iter().filter(|f| f.check == "variance" && f.verdict != Verdict::Pass);
    let variances: Vec<Finding> = variances.cloned().collect();
    let channels = planned.outcome.as_ref().map_or(&[][..], |ready| &ready.prediction.channels);
    let is_piloted = |name: &str| channels.iter().any(|c| c.by_pilots && c.name == name);
    for mean in findings.iter_mut().filter(|finding| finding.check == "mean") {
        let variance = variances.iter().find(|variance| variance.channel == mean.channel);
        let (verdict, reason) = match (mean.verdict, variance.filter(|_| !mean.expects_bias)) {
            (Verdict::Pass, Some(variance)) if variance.verdict != Verdict::Underpowered => {
                (Verdict::Inconclusive, Reason::VarianceOpen)
            }
            (Verdict::Pass, Some(_)) => (Verdict::Pass, Reason::VarianceAssumed),
            (Verdict::Pass, None) if !mean.expects_bias && is_piloted(&mean.channel) => {
                (Verdict::Pass, Reason::VarianceAssumed)
            }
            (Verdict::Fail, Some(variance)) if rests_on(plan, mean, variance) => {
                (Verdict::Inconclusive, Reason::RestsOnVariance("the mean".into()))
            }
            _ => continue,
        };
        mean.verdict = verdict;
        mean.reason = reason.to_string();
    }
}

/// Adds the cause to blocks and streams that differ from theory where the mean or the variance fails: the difference is then
/// no sign of a dependence.
pub fn explain_blocks(findings: &mut [Finding]) {
    let fails = |check: &str| {
        findings.iter().any(|found| found.check == check && found.verdict == Verdict::Fail)
    };
    let cause = match [fails("mean"), fails("variance")] {
        [true, _] => "the mean is off",
        [_, true] => "the variance is off",
        _ => return,
    };
    let blocks = findings.iter_mut().filter(|found| {
        ["dispersion", "streams"].contains(&found.check.as_str()) && found.verdict == Verdict::Fail
    });
    for found in blocks {
        found.reason = format!("{}, which follows where {cause}", found.reason);
    }
}

/// Whether a mean fails only by a variance that is refuted as too small.
fn rests_on(plan: &Plan, mean: &Finding, variance: &Finding) -> bool {
    let gates = mean.gate.zip(variance.gate).filter(|_| variance.verdict == Verdict::Fail);
    gates.is_some_and(|(mean, variance)| session::rests_on(&mean, &variance, plan.levels.ln_fail))
}

/// A bias somewhere on a curve is a bias; it need not be everywhere.
pub fn show_anywhere(findings: &mut [Finding]) {
    let shown = |finding: &Finding| finding.check == "mean" && finding.verdict == Verdict::Pass;
    if findings.iter().any(shown) {
        for finding in findings.iter_mut().filter(|finding| finding.check == "mean") {
            if finding.verdict != Verdict::Pass {
                finding.verdict = Verdict::Pass;
                finding.reason = Reason::BiasedElsewhere.to_string();
            }
        }
    }
}

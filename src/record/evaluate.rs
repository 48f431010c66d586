//! Turns totals into findings, one per question.
//!
//! ```text
//! gate   failed ⇒ fail, passed ⇒ pass, open ⇒ underpowered if that was known, else inconclusive
//! distribution  p-values of the whole run together, by Holm; none where the draws were cut short
//! bound  broken by any draw ⇒ fail
//! ```
//!
//! A mean passes only together with its variance. Where the variance is underpowered the finding says
//! `variance assumed`; where it fails or is undecided the mean is inconclusive. A mean that is underpowered makes its
//! experiment inconclusive unless the case allows it.

use crate::case::Ready;
use crate::draw::block::{DrawnExperiment, Draws};
use crate::plan::{Plan, PlannedExperiment};
use crate::record::{Finding, Verdict};
use checks::check::{CheckResult, Context, Look, Total};
use checks::{Inspected, Question};
use gate::CheckId;
use gate::deviation::Deviation;
use gate::session::{self, Reason};
use gate::stats::multiplicity;
use gate::stats::verdict::BLOCK;
use theory::parallel;

/// Experiment with its draws and the findings of its checks.
pub struct Judged<'d> {
    /// The experiment with its draws.
    pub of: &'d DrawnExperiment<'d>,
    /// The findings, in the order of the questions.
    pub findings: Vec<Finding>,
}

impl Judged<'_> {
    /// Returns the number of means that pass with a variance that is assumed.
    pub fn assumed(&self) -> usize {
        let is_one = |finding: &&Finding| {
            is_passing_mean(finding)
                && !finding.expects_bias
                && finding.reason == Some(Reason::VarianceAssumed)
        };
        self.findings.iter().filter(is_one).count()
    }
}

fn is_passing_mean(finding: &Finding) -> bool {
    finding.check == CheckId::Mean && finding.verdict == Verdict::Pass
}

/// Judges the draws of a plan, experiment by experiment.
pub fn run<'d>(plan: &Plan, draws: &'d Draws) -> Vec<Judged<'d>> {
    let mut judged =
        parallel::map(&draws.experiments, |of| Judged { of, findings: findings(plan, of) });
    let mut all: Vec<&mut Finding> = judged.iter_mut().flat_map(|one| &mut one.findings).collect();
    judge_distributions(plan, &mut all);
    for one in &mut judged {
        explain_blocks(&mut one.findings);
    }
    judged
}

/// Returns the findings about an experiment; p-values of distributions are still to be judged together.
fn findings(plan: &Plan, of: &DrawnExperiment) -> Vec<Finding> {
    let DrawnExperiment { planned, drawn, .. } = of;
    if drawn.draws == 0 {
        return vec![Finding {
            check: CheckId::Mean,
            what: "the mean".to_owned(),
            expects_bias: false,
            channel: String::new(),
            z: None,
            result: CheckResult::new(Verdict::Inconclusive, Some(Reason::NothingDrawn)),
        }];
    }
    let Ok(ready) = &planned.outcome else { return Vec::new() };
    let both = planned.questions.iter().zip(&drawn.totals);
    let result = both.map(|(question, total)| finding(plan, of, ready, question, total));
    let mut findings: Vec<Finding> = result.collect();
    qualify_means(planned, &mut findings);
    if planned.expect_biased {
        show_anywhere(&mut findings);
    }
    findings
}

fn finding(
    plan: &Plan,
    of: &DrawnExperiment,
    ready: &Ready,
    question: &Question,
    total: &Total,
) -> Finding {
    let DrawnExperiment { planned, drawn, .. } = of;
    let channel = question.channel.map(|index| &ready.prediction.channels[index]);
    let levels = plan.levels.of(question.expects_bias);
    // Deviation of the channel's mean from the truth.
    let deviation = question.channel.zip(channel).and_then(|(index, channel)| {
        let (tally, truth) = (drawn.tallies.get(index)?, channel.truth.value);
        let mean = channel.mean.value + tally.moments()?.mean * truth;
        Some(Deviation::new(mean, truth, tally.draws))
    });
    let result = question.answer.finish(
        total,
        &Context {
            what: &question.what,
            expects_bias: question.expects_bias,
            look: Look { draws: drawn.draws, planned: planned.draws, levels },
            fixed: planned.fixed,
            too_weak: question.too_weak,
            mean: deviation,
            log_unit: channel.map_or(0.0, |channel| channel.log_unit),
            inspected: &Inspected {
                experiment: ready.experiment.as_ref(),
                channels: ready.prediction.channels.len(),
                streams: &|block| planned.streams(block),
                blocks: planned.fixed.div_ceil(BLOCK),
            },
        },
    );
    Finding {
        check: question.check,
        what: question.what.clone(),
        expects_bias: question.expects_bias,
        channel: channel.map_or(String::new(), |channel| channel.name.clone()),
        z: None,
        result: CheckResult { path: thinned(&result.path), ..result },
    }
}

/// Judges the p-values of a run together.
fn judge_distributions(plan: &Plan, findings: &mut [&mut Finding]) {
    let p: Vec<Option<f64>> = findings.iter().map(|finding| finding.p).collect();
    let rejected =
        multiplicity::holm(&p, plan.levels.distributions, plan.levels.distribution_alpha);
    for ((finding, p), rejected) in findings.iter_mut().zip(p).zip(rejected) {
        // A p-value of NaN comes from draws that are not finite.
        if let Some(p) = p.filter(|p| rejected || p.is_nan()) {
            finding.verdict = Verdict::Fail;
            let (what, p) = (finding.what.clone().into(), format!("{p:.1e}"));
            finding.reason = Some(Reason::Differs { what, p, details: String::new() });
        }
    }
}

/// Combines the verdict on each mean with that on the variance of its channel, see [`session::beside_variance`]. The
/// variance of pilot draws cannot be tested.
fn qualify_means(planned: &PlannedExperiment, findings: &mut [Finding]) {
    let open =
        |finding: &&Finding| finding.check == CheckId::Variance && finding.verdict != Verdict::Pass;
    let variances = findings
        .iter()
        .filter(open)
        .map(|finding| (finding.channel.clone(), (finding.verdict, finding.gate)));
    let channels = planned.outcome.as_ref().map_or(&[][..], |ready| &ready.prediction.channels);
    let pilots = channels.iter().filter(|channel| channel.pilot_variance_allowed);
    let pilots = pilots.map(|channel| (channel.name.clone(), (Verdict::Underpowered, None)));
    let variances: Vec<_> = variances.chain(pilots).collect();
    let is_mean = |finding: &&mut Finding| finding.check == CheckId::Mean && !finding.expects_bias;
    for mean in findings.iter_mut().filter(is_mean) {
        let variance = variances.iter().find(|(channel, _)| *channel == mean.channel);
        let is_off =
            |variance: &_| mean.gate.is_none_or(|mean| session::is_off_by_itself(&mean, variance));
        let verdict = variance.and_then(|&(_, variance)| {
            session::beside_variance("the mean", mean.verdict, variance, is_off)
        });
        if let Some((verdict, why)) = verdict {
            (mean.verdict, mean.reason) = (verdict, Some(why));
        }
    }
}

/// Adds the cause to blocks and streams that differ from theory if the mean or the variance fails: the difference is
/// then no evidence of a dependence.
fn explain_blocks(findings: &mut [Finding]) {
    let fails = |check: CheckId| {
        findings.iter().any(|finding| finding.check == check && finding.verdict == Verdict::Fail)
    };
    let from = match [fails(CheckId::Mean), fails(CheckId::Variance)] {
        [true, _] => "the mean",
        [_, true] => "the variance",
        _ => return,
    };
    let is_of_blocks = |finding: &&mut Finding| {
        matches!(finding.check, CheckId::Dispersion | CheckId::Streams)
            && finding.verdict == Verdict::Fail
    };
    for finding in findings.iter_mut().filter(is_of_blocks) {
        let of = finding.reason.take().map(Box::new);
        finding.reason = of.map(|of| Reason::Follows { of, from: from.into() });
    }
}

/// Counts a declared bias as shown if one point of a curve shows it.
fn show_anywhere(findings: &mut [Finding]) {
    if !findings.iter().any(is_passing_mean) {
        return;
    }
    for mean in findings.iter_mut().filter(|finding| finding.check == CheckId::Mean) {
        if mean.verdict != Verdict::Pass {
            (mean.verdict, mean.reason) = (Verdict::Pass, Some(Reason::BiasedElsewhere));
        }
    }
}

/// Maximum number of looks in a record.
const LOOKS: usize = 64;

/// Returns number of draws and ln E at the looks of a record: the first, the last, and an even choice between them. An
/// infinite ln E becomes the largest number.
fn thinned(path: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let last = path.len().saturating_sub(1);
    let few = path.len().min(LOOKS);
    let kept = (0..few).map(|i| path[i * last / (few - 1).max(1)]);
    kept.map(|[draws, ln_e]| [draws, rounded(ln_e)]).collect()
}

/// Rounds to steps of 0.001; infinity becomes the largest number.
fn rounded(ln_e: f64) -> f64 {
    ((ln_e * 1e3).round() / 1e3).clamp(f64::MIN, f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_keeps_its_ends_and_its_order() {
        for looks in [0, 1, 2, 63, 64, 65, 200] {
            let path: Vec<[f64; 2]> =
                (0..looks).map(|i| [f64::from(i * i), f64::from(i) / 8.0]).collect();
            let kept = thinned(&path);
            assert_eq!(kept.len(), path.len().min(LOOKS));
            assert!(kept.is_sorted_by(|a, b| a[0] < b[0]), "{kept:?}");
            assert_eq!(kept.last(), path.last());
            assert_eq!(kept.is_empty(), path.is_empty());
        }
    }
}

//! Turns totals into answers, one per question. Their reasons become words in the record alone.
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
use crate::plan::{Plan, Planned};
use crate::record::{Finding, Verdict};
use checks::check::{Context, Look, Total};
use checks::{Inspected, Question};
use gate::CheckId;
use gate::deviation::Deviation;
use gate::session::{self, Reason};
use gate::stats::multiplicity;
use gate::stats::verdict::BLOCK;
use theory::parallel;

/// Experiment with its draws and the answers of its checks.
pub struct Judged<'d> {
    /// The experiment with its draws.
    pub of: &'d DrawnExperiment<'d>,
    /// The answers, in the order of the questions.
    answers: Vec<Answer>,
}

/// Answer of a check to a question: a finding, and its reason before it is put into words.
struct Answer {
    finding: Finding,
    reason: Option<Reason>,
}

impl Judged<'_> {
    /// Returns the findings, with their reasons in words.
    pub fn findings(&self) -> Vec<Finding> {
        let worded = |Answer { finding, reason }: &Answer| Finding {
            reason: reason.as_ref().map_or_else(String::new, Reason::to_string),
            ..finding.clone()
        };
        self.answers.iter().map(worded).collect()
    }

    /// Returns the number of means that pass with a variance that is assumed.
    pub fn assumed(&self) -> usize {
        let is_one = |answer: &&Answer| {
            answer.is_passing_mean()
                && !answer.finding.expects_bias
                && answer.reason == Some(Reason::VarianceAssumed)
        };
        self.answers.iter().filter(is_one).count()
    }
}

impl Answer {
    fn is(&self, check: CheckId) -> bool {
        self.finding.check == check
    }

    fn is_passing_mean(&self) -> bool {
        self.is(CheckId::Mean) && self.finding.verdict == Verdict::Pass
    }
}

/// Judges the draws of a plan, experiment by experiment.
pub fn run<'d>(plan: &Plan, draws: &'d Draws) -> Vec<Judged<'d>> {
    let mut judged =
        parallel::map(&draws.experiments, |of| Judged { of, answers: answers(plan, of) });
    let mut all: Vec<&mut Answer> = judged.iter_mut().flat_map(|one| &mut one.answers).collect();
    judge_distributions(plan, &mut all);
    for one in &mut judged {
        explain_blocks(&mut one.answers);
    }
    judged
}

/// Returns a finding without a result.
fn blank(check: CheckId, what: &str, channel: String) -> Finding {
    Finding {
        check,
        what: what.to_owned(),
        expects_bias: false,
        channel,
        z: None,
        p: None,
        gate: None,
        path: Vec::new(),
        block: None,
        verdict: Verdict::Inconclusive,
        reason: String::new(),
    }
}

/// Returns the answers about an experiment; p-values of distributions are still to be judged together.
fn answers(plan: &Plan, of: &DrawnExperiment) -> Vec<Answer> {
    let DrawnExperiment { planned, drawn, .. } = of;
    if drawn.draws == 0 {
        let finding = blank(CheckId::Mean, "the mean", String::new());
        return vec![Answer { finding, reason: Some(Reason::NothingDrawn) }];
    }
    let Ok(ready) = &planned.outcome else { return Vec::new() };
    let both = planned.questions.iter().zip(&drawn.totals);
    let found = both.map(|(question, total)| answer(plan, of, ready, question, total));
    let mut answers: Vec<Answer> = found.collect();
    qualify_means(planned, &mut answers);
    if planned.expect_biased {
        show_anywhere(&mut answers);
    }
    answers
}

fn answer(
    plan: &Plan,
    of: &DrawnExperiment,
    ready: &Ready,
    question: &Question,
    total: &Total,
) -> Answer {
    let DrawnExperiment { planned, drawn, .. } = of;
    let channel = question.channel.map(|index| &ready.prediction.channels[index]);
    let levels = plan.levels.of(question.expects_bias);
    // Deviation of the channel's mean from the truth.
    let deviation = question.channel.zip(channel).and_then(|(index, channel)| {
        let (tally, truth) = (drawn.tallies.get(index)?, channel.truth.value);
        let mean = channel.mean.value + tally.moments()?.mean * truth;
        Some(Deviation::new(mean, truth, tally.draws))
    });
    let found = question.answer.finish(
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
    let channel = channel.map_or(String::new(), |channel| channel.name.clone());
    let finding = Finding {
        expects_bias: question.expects_bias,
        p: found.p,
        gate: found.gate,
        path: thinned(&found.path),
        block: found.block,
        verdict: found.verdict,
        ..blank(question.check, &question.what, channel)
    };
    Answer { finding, reason: found.reason }
}

/// Judges the p-values of a run together.
fn judge_distributions(plan: &Plan, answers: &mut [&mut Answer]) {
    let p: Vec<Option<f64>> = answers.iter().map(|answer| answer.finding.p).collect();
    let rejected =
        multiplicity::holm(&p, plan.levels.distributions, plan.levels.distribution_alpha);
    for ((answer, p), rejected) in answers.iter_mut().zip(p).zip(rejected) {
        // A p-value of NaN comes from draws that are not finite.
        if let Some(p) = p.filter(|p| rejected || p.is_nan()) {
            answer.finding.verdict = Verdict::Fail;
            let (what, p) = (answer.finding.what.clone().into(), format!("{p:.1e}"));
            answer.reason = Some(Reason::Differs { what, p, details: String::new() });
        }
    }
}

/// Combines the verdict on each mean with that on the variance of its channel, see [`session::beside_variance`]. The
/// variance of pilot draws cannot be tested.
fn qualify_means(planned: &Planned, answers: &mut [Answer]) {
    let open =
        |answer: &&Answer| answer.is(CheckId::Variance) && answer.finding.verdict != Verdict::Pass;
    let variances = answers
        .iter()
        .filter(open)
        .map(|Answer { finding, .. }| (finding.channel.clone(), (finding.verdict, finding.gate)));
    let channels = planned.outcome.as_ref().map_or(&[][..], |ready| &ready.prediction.channels);
    let pilots = channels.iter().filter(|channel| channel.pilot_variance_allowed);
    let pilots = pilots.map(|channel| (channel.name.clone(), (Verdict::Underpowered, None)));
    let variances: Vec<_> = variances.chain(pilots).collect();
    let is_mean = |answer: &&mut Answer| answer.is(CheckId::Mean) && !answer.finding.expects_bias;
    for Answer { finding: mean, reason } in answers.iter_mut().filter(is_mean) {
        let variance = variances.iter().find(|(channel, _)| *channel == mean.channel);
        let is_off =
            |variance: &_| mean.gate.is_none_or(|mean| session::is_off_by_itself(&mean, variance));
        let verdict = variance.and_then(|&(_, variance)| {
            session::beside_variance("the mean", mean.verdict, variance, is_off)
        });
        if let Some((verdict, why)) = verdict {
            (mean.verdict, *reason) = (verdict, Some(why));
        }
    }
}

/// Adds the cause to blocks and streams that differ from theory if the mean or the variance fails: the difference is
/// then no evidence of a dependence.
fn explain_blocks(answers: &mut [Answer]) {
    let fails = |check: CheckId| {
        answers.iter().any(|answer| answer.is(check) && answer.finding.verdict == Verdict::Fail)
    };
    let from = match [fails(CheckId::Mean), fails(CheckId::Variance)] {
        [true, _] => "the mean",
        [_, true] => "the variance",
        _ => return,
    };
    let is_of_blocks = |answer: &&mut Answer| {
        let is_either = answer.is(CheckId::Dispersion) || answer.is(CheckId::Streams);
        is_either && answer.finding.verdict == Verdict::Fail
    };
    for answer in answers.iter_mut().filter(is_of_blocks) {
        let of = answer.reason.take().map(Box::new);
        answer.reason = of.map(|of| Reason::Follows { of, from: from.into() });
    }
}

/// Counts a declared bias as shown if one point of a curve shows it.
fn show_anywhere(answers: &mut [Answer]) {
    if !answers.iter().any(Answer::is_passing_mean) {
        return;
    }
    for answer in answers.iter_mut().filter(|answer| answer.is(CheckId::Mean)) {
        if answer.finding.verdict != Verdict::Pass {
            answer.finding.verdict = Verdict::Pass;
            answer.reason = Some(Reason::BiasedElsewhere);
        }
    }
}

/// Maximum number of looks in a record.
const LOOKS: usize = 64;

/// Returns number of draws and ln E at the looks of a record: the first, the last, and an even choice between them. An
/// infinite ln E becomes the largest number.
fn thinned(path: &[(u64, f64)]) -> Vec<[f64; 2]> {
    let last = path.len().saturating_sub(1);
    let few = path.len().min(LOOKS);
    let kept = (0..few).map(|i| path[i * last / (few - 1).max(1)]);
    kept.map(|(draws, ln_e)| [draws as f64, rounded(ln_e)]).collect()
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
            let path: Vec<(u64, f64)> = (0..looks).map(|i| (i * i, i as f64 / 8.0)).collect();
            let kept = thinned(&path);
            assert_eq!(kept.len(), path.len().min(LOOKS));
            assert!(kept.is_sorted_by(|a, b| a[0] < b[0]), "{kept:?}");
            let last = path.last().map(|&(draws, ln_e)| [draws as f64, ln_e]);
            assert_eq!(kept.last().copied(), last);
            assert_eq!(kept.is_empty(), path.is_empty());
        }
    }
}

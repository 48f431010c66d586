//! From totals to findings: what each question's answer means.
//!
//! ```text
//! gate   failed ⇒ fail, passed ⇒ pass, open ⇒ underpowered if that was known, else inconclusive
//! law    p-values of the whole run together, by Holm; none where the draws were cut short
//! bound  broken by any draw ⇒ fail
//! ```
//!
//! A mean passes on the strength of its variance; where that one is underpowered the finding says
//! `variance assumed`, where it fails or is undecided the mean is inconclusive. A mean that is underpowered makes its experiment inconclusive unless the
//! case allows it.

use crate::case::build::Ready;
use crate::checks::check::{Context, Look, Total};
use crate::checks::{Inspected, Question};
use crate::draw::drawn::{Drawn, Draws};
use crate::plan::foreseen::too_weak;
use crate::plan::{BLOCK, Plan, Planned, PlannedCase};
use crate::record::plot_data::thinned;
use crate::record::qualify::{qualify_means, show_anywhere};
use crate::record::{Finding, Verdict};
use gate::deviation::Deviation;
use gate::session::Reason;
use gate::stats::multiplicity;
use theory::parallel;

/// What is found of a run: per case, per experiment, per question.
pub fn run(plan: &Plan, draws: &Draws) -> Vec<Vec<Vec<Finding>>> {
    let pairs: Vec<_> = plan.cases.iter().zip(&draws.cases).collect();
    let mut findings: Vec<Vec<Vec<Finding>>> = parallel::map(&pairs, |&(case, drawn)| {
        let both: Vec<_> = case.experiments.iter().zip(drawn).collect();
        parallel::map(&both, |&(planned, drawn)| {
            Experiment { plan, case, planned, drawn }.findings()
        })
    });
    judge_laws(plan, &mut findings.iter_mut().flatten().flatten().collect::<Vec<_>>());
    findings
}

/// A finding that says nothing yet.
fn blank(check: &str, what: &str, channel: String) -> Finding {
    Finding {
        check: check.to_owned(),
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

/// An experiment and what it drew.
struct Experiment<'a> {
    plan: &'a Plan<'a>,
    case: &'a PlannedCase<'a>,
    planned: &'a Planned,
    drawn: &'a Drawn,
}

impl Experiment<'_> {
    /// What is found; laws still have to be judged together.
    fn findings(&self) -> Vec<Finding> {
        if self.drawn.draws == 0 {
            let reason = "the limit of time or draws came before the first draw".to_owned();
            return vec![Finding { reason, ..blank("mean", "the mean", String::new()) }];
        }
        let Ok(ready) = &self.planned.outcome else { return Vec::new() };
        let both = self.planned.questions.iter().zip(&self.drawn.totals);
        let mut findings: Vec<Finding> =
            both.map(|(question, total)| self.finding(ready, question, total)).collect();
        qualify_means(self.plan, self.planned, &mut findings);
        if self.planned.expect_biased {
            show_anywhere(&mut findings);
        }
        findings
    }

    fn finding(&self, ready: &Ready, question: &Question, total: &Total) -> Finding {
        let Self { plan, case, planned, drawn } = *self;
        let channel = question.channel.map(|index| &ready.prediction.channels[index]);
        let look = Look {
            draws: drawn.draws,
            planned: planned.draws,
            levels: plan.levels.of(question.expects_bias),
        };
        let inspected = Inspected {
            experiment: ready.experiment.as_ref(),
            channels: ready.prediction.channels.len(),
            streams: &|block| planned.streams(block),
            blocks: planned.fixed.div_ceil(BLOCK),
        };
        let found = question.answer.finish(
            total,
            &Context {
                what: &question.what,
                expects_bias: question.expects_bias,
                look,
                fixed: planned.fixed,
                too_weak: too_weak(plan, case, question),
                mean: question.channel.and_then(|index| self.mean(ready, index)),
                log_unit: channel.map_or(0.0, |channel| channel.log_unit),
                inspected: &inspected,
            },
        );
        let channel = channel.map_or(String::new(), |channel| channel.name.clone());
        Finding {
            expects_bias: question.expects_bias,
            p: found.p,
            gate: found.gate,
            path: thinned(&found.path),
            block: found.block,
            verdict: found.verdict,
            reason: found.reason.map_or(String::new(), |reason| reason.to_string()),
            ..blank(&question.check, &question.what, channel)
        }
    }

    /// Deviation of a channel's mean from the truth.
    fn mean(&self, ready: &Ready, index: usize) -> Option<Deviation> {
        let channel = &ready.prediction.channels[index];
        let (tally, truth) = (self.drawn.tallies.get(index)?, channel.truth.value);
        let mean = channel.mean.value + tally.moments()?.mean * truth;
        Some(Deviation::new(mean, truth, tally.draws))
    }
}

/// Judges the p-values of a run together.
fn judge_laws(plan: &Plan, findings: &mut [&mut Finding]) {
    let p: Vec<f64> = findings.iter().filter_map(|finding| finding.p).collect();
    let rejected = multiplicity::holm(&p, plan.levels.laws, plan.levels.law_alpha);
    let laws = findings.iter_mut().filter(|finding| finding.p.is_some());
    for (finding, rejected) in laws.zip(rejected) {
        // A p-value that is not a number comes from draws that are none.
        if rejected || finding.p.is_some_and(f64::is_nan) {
            finding.verdict = Verdict::Fail;
            let (what, p) = (finding.what.clone().into(), finding.p.unwrap_or(0.0));
            let differs = Reason::Differs { what, p: format!("{p:.1e}"), details: String::new() };
            finding.reason = differs.to_string();
        }
    }
}

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

use crate::checks::{Always, Inspected, Kind, Question, Scalar};
use crate::draw::drawn::{Drawn, Draws, GateState, Total};
use crate::plan::foreseen::{lack, too_weak, untestable};
use crate::plan::{BLOCK, Plan, Planned, PlannedCase};
use crate::record::plot_data::thinned;
use crate::record::qualify::{qualify_means, show_anywhere};
use crate::record::{Finding, GateFinding, Verdict};
use gate::deviation::{Deviation, signed_percent};
use gate::stats::gate::Decision;
use gate::stats::multiplicity;
use numeric::digits::{self, short};
use numeric::sum::Sum;
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

/// A finding without an answer.
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
        let both = self.planned.questions.iter().zip(&self.drawn.totals);
        let mut findings: Vec<Finding> =
            both.filter_map(|(question, total)| self.finding(question, total)).collect();
        qualify_means(self.plan, self.planned, &mut findings);
        if self.planned.expect_biased {
            show_anywhere(&mut findings);
        }
        findings
    }

    fn finding(&self, question: &Question, total: &Total) -> Option<Finding> {
        let Self { planned, drawn, .. } = *self;
        let channels = planned.outcome.as_ref().map_or(&[][..], |ready| &ready.prediction.channels);
        let channel = question.channel.map_or(String::new(), |index| channels[index].name.clone());
        let expects_bias = question.expects_bias;
        let finding = Finding { expects_bias, ..blank(&question.check, &question.what, channel) };
        Some(match (&question.kind, total) {
            (Kind::Scalar(scalar), Total::Gate(state)) => {
                let (verdict, reason) = if question.expects_bias {
                    self.biased(state)
                } else {
                    self.decided(question, scalar, state)
                };
                let gate = Some(self.gate_finding(question, scalar, state));
                let (path, block) = (thinned(&state.path), state.draws.saturating_sub(1) / BLOCK);
                Finding { gate, path, block: Some(block), verdict, reason, ..finding }
            }
            (Kind::Law(_), Total::Law(_)) if drawn.draws < planned.fixed => {
                let (what, fixed, drawn) = (&question.what, planned.fixed, drawn.draws);
                let reason = format!("{what}: cut after {drawn} of {fixed} draws");
                Finding { reason, ..finding }
            }
            (Kind::Law(law), Total::Law(sums)) => {
                let sums: Vec<f64> = sums.iter().map(Sum::value).collect();
                let p = law.p_value(&sums, planned.fixed as f64);
                let (verdict, reason) = if p.is_some() {
                    (Verdict::Pass, String::new())
                } else {
                    let reason = format!("{} has too few draws for a test", question.what);
                    (Verdict::Underpowered, reason)
                };
                Finding { p, verdict, reason, ..finding }
            }
            (Kind::Inspection(look), _) => {
                let ready = planned.outcome.as_ref().ok()?;
                let inspected = Inspected {
                    experiment: ready.experiment.as_ref(),
                    channels: channels.len(),
                    streams: &|block| planned.streams(block),
                    blocks: planned.fixed.div_ceil(BLOCK),
                };
                Finding { p: Some(look(&inspected)), verdict: Verdict::Pass, ..finding }
            }
            (Kind::Always(always), &Total::Largest(largest, block)) => {
                let (verdict, reason) = self.kept(question, always, largest);
                let block = (verdict == Verdict::Fail).then_some(block);
                Finding { block, verdict, reason, ..finding }
            }
            (Kind::Untestable(why), _) => {
                let reason = untestable(&question.what, why);
                let verdict = too_weak(self.plan, self.case, question);
                Finding { verdict, reason, ..finding }
            }
            _ => return None,
        })
    }

    fn gate_finding(&self, question: &Question, scalar: &Scalar, state: &GateState) -> GateFinding {
        let levels = &self.plan.levels;
        GateFinding {
            tolerance: scalar.design.tolerance,
            variance: scalar.design.variance,
            mean: state.mean,
            planned: scalar.draws,
            draws: state.draws,
            ln_e: state.evidence.ln_e,
            ln_e_limit: if question.expects_bias { levels.ln_biased } else { levels.ln_fail },
            ln_p: state.evidence.ln_pass,
            ln_p_limit: levels.ln_pass,
            needed: scalar.underpowered,
            is_decided: state.decision != Decision::Open,
        }
    }

    fn decided(
        &self,
        question: &Question,
        scalar: &Scalar,
        state: &GateState,
    ) -> (Verdict, String) {
        let what = &question.what;
        let evidence = &state.evidence;
        match state.decision {
            Decision::Passed => (Verdict::Pass, String::new()),
            Decision::Failed => {
                let reason = format!(
                    "{what} is off by {} (ln E = {:.1} ≥ {:.1})",
                    self.deviation(question, scalar, state),
                    evidence.ln_e,
                    self.plan.levels.ln_fail
                );
                (Verdict::Fail, reason)
            }
            Decision::Open => {
                if let Some(needed) = scalar.underpowered {
                    let verdict = too_weak(self.plan, self.case, question);
                    return (verdict, lack(what, scalar, needed));
                }
                let [above, below] = evidence.ln_pass;
                let reason = format!(
                    "{what} is undecided after {} draws (ln P = {above:.1} and {below:.1} of {:.1})",
                    state.draws, self.plan.levels.ln_pass
                );
                (Verdict::Inconclusive, reason)
            }
        }
    }

    /// Deviation of a scalar from theory, in words.
    fn deviation(&self, question: &Question, scalar: &Scalar, state: &GateState) -> String {
        let &Scalar { expected, scale, design, .. } = scalar;
        let error = (design.variance / state.draws as f64).sqrt();
        let measured = expected + scale * state.mean;
        let told = Deviation::new(measured, expected, state.draws).with_z(state.mean / error);
        let mut text = told.to_string();
        // A thin medium is judged by its opacity.
        if question.check == "mean" && (scale - expected.abs()).abs() > 1e-9 * scale {
            text = format!("{text}, {} of the opacity", signed_percent(state.mean));
        }
        let channel = question.channel.zip(self.planned.outcome.as_ref().ok());
        let unit = channel.map_or(0.0, |(c, ready)| ready.prediction.channels[c].log_unit);
        if question.check == "mean" && unit != 0.0 {
            text = format!("{text}, in units of exp(−{})", short(unit, 6));
        }
        text
    }

    /// The verdict on a bias that the case declares.
    fn biased(&self, state: &GateState) -> (Verdict, String) {
        let bias = percent(state.mean);
        let was_cut = self.drawn.draws < self.planned.draws;
        match state.decision {
            Decision::Failed => (Verdict::Pass, format!("biased-as-expected: {bias}")),
            Decision::Open if was_cut => {
                let reason = format!("the bias is not shown after {} draws", state.draws);
                (Verdict::Inconclusive, reason)
            }
            _ => {
                let (found, limit) = (state.evidence.ln_e, self.plan.levels.ln_biased);
                let reason =
                    format!("expected a bias, found {bias} (ln E = {found:.1} of {limit:.1})");
                (Verdict::Fail, reason)
            }
        }
    }

    /// The verdict on a bound that every draw must keep.
    fn kept(&self, question: &Question, always: &Always, largest: f64) -> (Verdict, String) {
        let what = &question.what;
        let is_kept = largest <= always.bound;
        if question.expects_bias {
            return if is_kept {
                (Verdict::Fail, "expected a bias, found none".into())
            } else {
                (Verdict::Pass, format!("biased-as-expected: {}", percent(largest)))
            };
        }
        if is_kept {
            (Verdict::Pass, String::new())
        } else if largest.is_nan() {
            (Verdict::Fail, "draws are not finite numbers".into())
        } else {
            let (most, bound) = (digits::percent(largest), digits::percent(always.bound));
            let reason = match (question.check.as_str(), self.mean(question)) {
                ("lookups", _) => {
                    format!(
                        "{what} is off by {largest:.0} in a draw; theory has one number for all"
                    )
                }
                ("mean", Some(mean)) => format!(
                    "{what} is off by {mean}; a draw by up to {most}, of which rounding explains {bound}"
                ),
                _ => format!("{what} is off by {most} in a draw; rounding explains {bound}"),
            };
            (Verdict::Fail, reason)
        }
    }

    /// Deviation of a channel's mean from the truth; `None` for an experiment as a whole.
    fn mean(&self, question: &Question) -> Option<Deviation> {
        let index = question.channel?;
        let channel = &self.planned.outcome.as_ref().ok()?.prediction.channels[index];
        let (tally, truth) = (self.drawn.tallies.get(index)?, channel.truth.value);
        let mean = channel.mean.value + tally.moments()?.mean * truth;
        Some(Deviation::new(mean, truth, tally.draws))
    }
}

/// A relative difference in percent.
fn percent(difference: f64) -> String {
    let percent = 100.0 * difference;
    if percent.abs() >= 0.01 { format!("{percent:+.2} %") } else { format!("{percent:+.1e} %") }
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
            let p = finding.p.unwrap_or(0.0);
            finding.reason = format!("{} differs from theory: p = {p:.1e}", finding.what);
        }
    }
}

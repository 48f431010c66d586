//! From a plan, or from what a plan drew, to a record.

use rayon::prelude::*;

use super::checks::{self, Evidence, Subject, lookups, mean, variance};
use super::curves;
use super::plan::{Plan, Planned, PlannedCase};
use super::record::{
    Anatomy, CaseRecord, Finding, MeasuredPoint, Record, Results, Row, Timing, Verdict,
};
use super::run::{Drawn, Draws};
use crate::theory::optimum::Optimum;

/// What a plan would do: one row per experiment and channel, nothing drawn.
#[must_use]
pub fn planned(plan: &Plan) -> Record {
    let rows = |case: &PlannedCase| -> Vec<Row> {
        case.experiments.iter().flat_map(theory_rows).collect()
    };
    let mut record = record(plan, plan.cases.iter().map(|case| (rows(case), None, None)));
    for (case, planned_case) in record.results.cases.iter_mut().zip(&plan.cases) {
        let draws = planned_case.experiments.iter().flat_map(|planned| {
            let rows = planned.outcome.as_ref().map_or(1, |ready| ready.prediction.channels.len());
            let draws = planned.outcome.is_ok().then_some(planned.draws);
            std::iter::repeat_n(draws, rows)
        });
        case.rows.iter_mut().zip(draws).for_each(|(row, draws)| row.draws = draws);
    }
    record
}

/// What theory says: the rows of a plan with the best constant σ̂ of each estimator.
#[must_use]
pub fn predicted(plan: &Plan) -> Record {
    let rows = |case: &PlannedCase| -> Vec<Row> {
        let best = curves::best_of_each(case.case, plan.options.seed);
        let rows = case.experiments.par_iter().map(|planned| {
            let optimum = best.get(planned.estimator).copied().flatten();
            let mut rows = theory_rows(planned);
            for row in rows.iter_mut().filter(|row| row.verdict.is_none()) {
                row.best_sampling = optimum.map(|best: Optimum| best.sampling);
                row.best_fom = optimum.map(|best| best.figure_of_merit);
            }
            rows
        });
        rows.flatten_iter().collect()
    };
    record(plan, plan.cases.iter().map(|case| (rows(case), None, None)))
}

/// What a plan drew, judged.
#[must_use]
pub fn judged(plan: &Plan, draws: &Draws, seconds: f64) -> Record {
    let pairs: Vec<_> = plan.cases.iter().zip(&draws.cases).collect();
    let parts: Vec<_> = pairs
        .par_iter()
        .map(|(case, drawn)| {
            let both = case.experiments.iter().zip(drawn.iter());
            let rows = both.clone().flat_map(|(planned, drawn)| judge(plan, case, planned, drawn));
            let rows: Vec<Row> = rows.collect();
            let sweep = curves::sweep(case.case, plan.options.seed, Some(plan.limits.z));
            let anatomy = both.clone().find_map(|(planned, drawn)| anatomy(case, planned, drawn));
            (rows, sweep, anatomy)
        })
        .collect();
    let mut record = record(plan, parts.into_iter());
    record.results.cut_by_time = draws.cut_by_time;
    record.timing.seconds = seconds;
    record.timing.rows = pairs
        .iter()
        .map(|(case, drawn)| {
            let both = case.experiments.iter().zip(drawn.iter());
            let seconds = both.flat_map(|(planned, drawn)| {
                let time = planned.outcome.is_ok().then_some(drawn.seconds);
                let rows = planned.outcome.as_ref().map_or(1, |r| r.prediction.channels.len());
                std::iter::repeat_n(time, rows)
            });
            seconds.collect()
        })
        .collect();
    record
}

type Part = (Vec<Row>, Option<super::record::Sweep>, Option<Anatomy>);

fn record(plan: &Plan, parts: impl Iterator<Item = Part>) -> Record {
    let cases: Vec<CaseRecord> = plan
        .cases
        .iter()
        .zip(parts)
        .map(|(planned, (rows, sweep, anatomy))| CaseRecord {
            name: planned.case.name.clone(),
            title: planned.case.title.clone(),
            problem: planned.case.problem.clone(),
            medium: planned.case.scenario.medium().to_owned(),
            rows,
            sweep,
            anatomy,
        })
        .collect();
    let timing = Timing {
        threads: rayon::current_num_threads(),
        seconds: 0.0,
        rows: cases.iter().map(|case| vec![None; case.rows.len()]).collect(),
    };
    let results = Results {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: plan.options.seed,
        alpha: plan.options.alpha,
        checks: plan.hypotheses,
        cut_by_time: false,
        cases,
    };
    Record { results, timing }
}

/// A longer list of probabilities is left out of the record.
const LONGEST_LAW: usize = 100;

/// The rows of an experiment with what theory says of each channel.
fn theory_rows(planned: &Planned) -> Vec<Row> {
    let blank = Row {
        estimator: planned.names.estimator.clone(),
        sampling: planned.names.sampling,
        sampling_kind: planned.names.sampling_kind.clone(),
        control: planned.names.control.clone(),
        swept: planned.variation.map(|(_, value)| value),
        ..Row::default()
    };
    let ready = match &planned.outcome {
        Ok(ready) => ready,
        Err(refusal) => {
            let reason = refusal.to_string();
            return vec![Row { verdict: Some(Verdict::Refused), reason, ..blank }];
        }
    };
    let prediction = &ready.prediction;
    let lookups = prediction.lookups.as_ref().map(|law| law.mean);
    let law = prediction.lookups.as_ref();
    let rows = prediction.channels.iter().map(|channel| {
        let variance = channel.moments.map(|moments| moments.variance());
        let fom = variance.zip(lookups).map(|(v, m)| 1.0 / (v * m));
        Row {
            channel: channel.name.clone(),
            truth: Some(channel.truth.value),
            truth_error: Some(channel.truth.error),
            predicted_variance: finite(variance),
            predicted_lookups: lookups,
            predicted_skewness: finite(channel.moments.and_then(|m| m.skewness())),
            predicted_kurtosis: finite(channel.moments.and_then(|m| m.kurtosis())),
            predicted_fom: finite(fom),
            stable_share: prediction.stable_share,
            losses: channel.losses,
            relative_moments: channel
                .moments
                .map_or([None; 3], |moments| moments.relative.map(|m| finite(Some(m)))),
            lookups_variance: law.map(|law| law.variance),
            lookups_pmf: law
                .filter(|law| law.pmf.len() <= LONGEST_LAW)
                .map_or_else(Vec::new, |law| law.pmf.clone()),
            rare_event_size: finite(channel.moments.map(|_| channel.tails.rare_event_size)),
            log_unit: Some(channel.log_unit).filter(|&unit| unit != 0.0),
            ..blank.clone()
        }
    });
    rows.collect()
}

fn finite(x: Option<f64>) -> Option<f64> {
    x.filter(|x| x.is_finite())
}

/// The rows of an experiment with what was drawn and found.
fn judge(plan: &Plan, case: &PlannedCase, planned: &Planned, drawn: &Drawn) -> Vec<Row> {
    let mut rows = theory_rows(planned);
    let Some(mut subject) = planned.subject(case.case) else { return rows };
    // A time limit may have left fewer draws than planned.
    subject.draws = drawn.lookups.draws;
    let findings = findings(plan, &subject, planned, drawn);
    if subject.draws == 0 {
        for row in &mut rows {
            row.findings.clone_from(&findings);
            (row.verdict, row.reason) = (Some(Verdict::Inconclusive), worst(&findings).1);
        }
        return rows;
    }
    let channels = subject.prediction.channels.iter();
    for ((row, tally), channel) in rows.iter_mut().zip(&drawn.tallies).zip(channels) {
        let n = tally.draws as f64;
        let unit = channel.truth.value;
        let moments = tally.moments();
        row.draws = Some(tally.draws);
        row.mean = finite(moments.map(|m| channel.mean.value + m.mean * unit));
        row.variance = finite(moments.and_then(|m| m.variance).map(|v| v * unit * unit));
        row.standard_error = row.variance.map(|v| (v / n).sqrt());
        row.variance_deviation =
            finite(channel.moments.and_then(|m| {
                Some(m.spread_of_sample_variance(n)?.max(0.0).sqrt() * m.variance())
            }));
        let certain = mean::is_certain(&subject, channel);
        let compared = mean::compare(&subject, channel, tally).filter(|_| !certain);
        row.z_mean = finite(compared.map(|comparison| comparison.z()));
        row.detectable_bias =
            finite(compared.map(|comparison| comparison.detectable(&plan.limits)));
        row.z_variance =
            finite(variance::compare(&subject, channel, tally).map(|comparison| comparison.z()));
        let lookups = drawn.lookups.moments();
        let predicted = subject.prediction.lookups.as_ref().map_or(0.0, |law| law.mean);
        row.lookups_per_draw = lookups.map(|m| m.mean + predicted);
        row.z_lookups = lookups::compare(&subject, &drawn.lookups).map(|comparison| comparison.z());
        row.lookups_deviation =
            subject.prediction.lookups.as_ref().map(|law| (law.variance / n).sqrt());
        let fom = row.variance.zip(row.lookups_per_draw).map(|(v, m)| 1.0 / (v * m));
        row.fom = finite(fom.filter(|_| !certain));
        row.p_law = findings.iter().filter_map(|finding| finding.p).reduce(f64::min);
        let about =
            |finding: &&Finding| finding.channel.is_empty() || finding.channel == channel.name;
        row.findings = findings.iter().filter(about).cloned().collect();
        let (verdict, reason) = worst(&row.findings);
        row.verdict = Some(verdict);
        row.reason = reason;
    }
    rows
}

fn findings(plan: &Plan, subject: &Subject, planned: &Planned, drawn: &Drawn) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, check) in checks::ALL.iter().enumerate() {
        if check.hypotheses(subject) == 0 {
            continue;
        }
        let none = Vec::new();
        let sums = drawn.sums.get(index).unwrap_or(&none);
        let evidence = Evidence { tallies: &drawn.tallies, lookups: &drawn.lookups, sums };
        if subject.draws > 0 {
            findings.extend(check.judge(subject, &plan.limits, &evidence));
        }
    }
    if planned.outcome.is_ok() && findings.is_empty() {
        let reason = "the time limit came before the first draw".to_owned();
        let (check, channel) = ("mean".into(), String::new());
        let verdict = Verdict::Inconclusive;
        findings.push(Finding { check, channel, z: None, p: None, verdict, reason });
    }
    findings
}

/// Fail before inconclusive before underpowered before pass, with every reason of that verdict.
fn worst(findings: &[Finding]) -> (Verdict, String) {
    let order = [Verdict::Fail, Verdict::Inconclusive, Verdict::Underpowered, Verdict::Pass];
    let found = |verdict: &Verdict| findings.iter().any(|finding| finding.verdict == *verdict);
    let verdict = order.into_iter().find(found).unwrap_or(Verdict::Pass);
    let mut reasons: Vec<&str> = Vec::new();
    for finding in findings.iter().filter(|finding| finding.verdict == verdict) {
        if !finding.reason.is_empty() && !reasons.contains(&finding.reason.as_str()) {
            reasons.push(&finding.reason);
        }
    }
    (verdict, reasons.join("; "))
}

/// The ray seen from the side, for an experiment on a curve.
fn anatomy(case: &PlannedCase, planned: &Planned, drawn: &Drawn) -> Option<Anatomy> {
    let ready = planned.outcome.as_ref().ok()?;
    let scenario = &case.case.scenario;
    let (portrait, explorers) =
        scenario.portrait(planned.estimator, planned.variation, planned.address)?;
    let distances = scenario.distances();
    let channels = ready.prediction.channels.iter().zip(&drawn.tallies).zip(&distances);
    let measured = channels.filter_map(|((channel, tally), &t)| {
        let moments = tally.moments()?;
        let unit = channel.truth.value;
        let deviation = moments.variance?.sqrt() * unit;
        Some(MeasuredPoint {
            t,
            mean: channel.mean.value + moments.mean * unit,
            standard_error: deviation / (tally.draws as f64).sqrt(),
            deviation,
        })
    });
    let residual = portrait.extinction.iter().zip(&portrait.control).map(|(s, c)| s - c).collect();
    let controlled = !planned.names.control.is_empty();
    Some(Anatomy {
        estimator: planned.names.estimator.clone(),
        measured: measured.collect(),
        residual,
        control: if controlled { portrait.control } else { Vec::new() },
        explorers,
        t: portrait.t,
        extinction: portrait.extinction,
        sampling: portrait.sampling,
        transmittance: portrait.transmittance,
        deviation: portrait.deviation,
        collisions: portrait.collisions,
        walks: portrait.walks,
    })
}

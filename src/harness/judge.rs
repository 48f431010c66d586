//! From a plan, or from what a plan drew, to a record.

use fearless_simd::Level;
use rayon::prelude::*;

use super::options::Options;
use super::plan::{MISS, Plan, Planned, PlannedCase};
use super::record::{
    Anatomy, CaseRecord, Finding, Gate, MeasuredPoint, Record, Results, Row, SCHEMA, Timing,
    Verdict,
};
use super::run::{Drawn, Draws};
use super::{curves, findings, normality, suite, summary};
use crate::numeric::pack;
use crate::stats::Tally;
use crate::theory::optimum::Optimum;
use crate::theory::{Channel, Prediction};

/// What a plan would do: one row per experiment and channel, nothing drawn.
#[must_use]
pub fn planned(plan: &Plan) -> Record {
    let rows = |case: &PlannedCase| -> Vec<Row> {
        let rows = case.experiments.iter().flat_map(|planned| {
            let mut rows = theory_rows(case, planned);
            for (channel, row) in
                rows.iter_mut().enumerate().filter(|(_, row)| row.verdict.is_none())
            {
                row.reason = findings::untestable(planned, channel);
            }
            rows
        });
        rows.collect()
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
            let mut rows = theory_rows(case, planned);
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
    let findings = findings::of_run(plan, draws);
    let parts: Vec<_> = pairs
        .par_iter()
        .zip(&findings)
        .map(|((case, drawn), findings)| {
            let both = case.experiments.iter().zip(drawn.iter());
            let rows = both.clone().zip(findings).flat_map(|((planned, drawn), findings)| {
                drawn_rows(plan, case, planned, drawn, findings)
            });
            let rows: Vec<Row> = rows.collect();
            let sweep = curves::sweep(case.case, plan.options.seed, Some(plan.levels.z));
            let anatomy = both.clone().find_map(|(planned, drawn)| anatomy(case, planned, drawn));
            (rows, sweep, anatomy)
        })
        .collect();
    let mut record = record(plan, parts.into_iter());
    record.results.cut_by_time = draws.cut_by_time;
    record.results.cut_by_budget = draws.cut_by_budget;
    summary::complete(&mut record.results);
    record.timing.seconds = seconds;
    for ((case, drawn), timing) in pairs.iter().zip(0..) {
        let both = case.experiments.iter().zip(drawn.iter());
        let rows = both.flat_map(|(planned, drawn)| {
            let time = planned.outcome.is_ok().then_some(drawn.seconds);
            let rows = planned.outcome.as_ref().map_or(1, |r| r.prediction.channels.len());
            std::iter::repeat_n((time, drawn.is_reused), rows)
        });
        (record.timing.rows[timing], record.timing.reused[timing]) = rows.unzip();
    }
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
            path: planned.case.path.display().to_string(),
            title: planned.case.title.clone(),
            problem: planned.case.problem.clone(),
            medium: planned.case.scenario.medium().to_owned(),
            visible_bias: None,
            pace: None,
            rows,
            sweep,
            anatomy,
        })
        .collect();
    let timing = Timing {
        threads: rayon::current_num_threads(),
        level: pack::word(Level::new()),
        seconds: 0.0,
        rows: cases.iter().map(|case| vec![None; case.rows.len()]).collect(),
        reused: cases.iter().map(|case| vec![false; case.rows.len()]).collect(),
    };
    let levels = &plan.levels;
    let gate = Gate {
        scalars: levels.scalars,
        laws: levels.laws,
        biased: levels.biased,
        beta: MISS,
        ln_e_limit: levels.ln_fail,
        ln_p_limit: levels.ln_pass,
        ..Gate::default()
    };
    let results = Results {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: plan.options.seed,
        alpha: plan.options.alpha,
        streams:
            "xoshiro256+ by address (seed, experiment, block, lane), seeded by PCG XSL RR 128/64; \
                  draw j of a block from lane j mod 16, order-free draws from branches of the lanes"
                .to_owned(),
        gate,
        cut_by_time: false,
        cut_by_budget: false,
        cases,
    };
    Record { results, timing, comparison: None }
}

/// A longer list of probabilities is left out of the record.
const LONGEST_LAW: usize = 100;

/// The rows of an experiment with what theory says of each channel.
fn theory_rows(case: &PlannedCase, planned: &Planned) -> Vec<Row> {
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
    let kernel = ready.experiment.order().word();
    let same_as = twin(case, planned).unwrap_or_default();
    let rows = prediction.channels.iter().map(|channel| {
        let variance = channel.moments.map(|moments| moments.variance());
        let fom = variance.zip(lookups).map(|(v, m)| 1.0 / (v * m));
        Row {
            kernel: kernel.to_owned(),
            sharing: sharing(case, planned),
            same_as: same_as.clone(),
            skipped: Some(ready.experiment.skipped()).filter(|&share| share > 0.0),
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
            eighth_moment_ratio: finite(channel.moments.map(|_| channel.tails.eighth_moment_ratio)),
            log_unit: Some(channel.log_unit).filter(|&unit| unit != 0.0),
            ..blank.clone()
        }
    });
    rows.collect()
}

/// The estimator that an experiment is by definition, where the case has it too.
fn twin(case: &PlannedCase, planned: &Planned) -> Option<String> {
    let index = case.experiments.iter().position(|other| std::ptr::eq(other, planned))?;
    case.twin(index).map(|twin| case.experiments[twin].names.estimator.clone())
}

/// How many experiments of the case share an experiment's lookups.
fn sharing(case: &PlannedCase, planned: &Planned) -> Option<u64> {
    let places = planned.places?;
    let all = case.experiments.iter().filter(|other| other.places == Some(places)).count();
    (all > 1).then_some(all as u64)
}

fn finite(x: Option<f64>) -> Option<f64> {
    x.filter(|x| x.is_finite())
}

/// The rows of an experiment with what was drawn and found.
fn drawn_rows(
    plan: &Plan,
    case: &PlannedCase,
    planned: &Planned,
    drawn: &Drawn,
    findings: &[Finding],
) -> Vec<Row> {
    let mut rows = theory_rows(case, planned);
    let Ok(ready) = &planned.outcome else { return rows };
    let prediction = &ready.prediction;
    let command = command(plan, case, planned);
    for (index, row) in rows.iter_mut().enumerate() {
        let channel = &prediction.channels[index];
        row.command.clone_from(&command);
        row.stream = Some(planned.address.experiment);
        row.drawn = Some(drawn.draws);
        if let Some(tally) = drawn.tallies.get(index) {
            measure(row, channel, tally);
            measure_lookups(row, prediction, drawn);
            row.not_normal = normality::marks(row, prediction, drawn.lookups.draws);
        }
        row.p_law = findings.iter().filter_map(|finding| finding.p).reduce(f64::min);
        let about =
            |finding: &&Finding| finding.channel.is_empty() || finding.channel == channel.name;
        row.findings = findings.iter().filter(about).cloned().collect();
        for finding in &mut row.findings {
            finding.z = match finding.check.as_str() {
                "mean" => row.z_mean,
                "variance" => row.z_variance,
                "lookups" => row.z_lookups,
                _ => None,
            };
        }
        let gate = |check: &str| row.findings.iter().find(|f| f.check == check)?.gate;
        row.detectable_bias = gate("mean").map(|gate| gate.tolerance);
        let (verdict, reason) = worst(&row.findings);
        (row.verdict, row.reason) = (Some(verdict), reason);
    }
    rows
}

/// Mean and variance of the fixed draws, and their z-scores.
fn measure(row: &mut Row, channel: &Channel, tally: &Tally) {
    let n = tally.draws as f64;
    let unit = channel.truth.value;
    let moments = tally.moments();
    row.draws = Some(tally.draws);
    row.mean = finite(moments.map(|m| channel.mean.value + m.mean * unit));
    row.variance = finite(moments.and_then(|m| m.variance).map(|v| v * unit * unit));
    row.standard_error = row.variance.map(|v| (v / n).sqrt());
    let Some(predicted) = channel.moments.filter(|m| m.relative[0] > CERTAIN) else { return };
    row.variance_deviation = finite(
        predicted.spread_of_sample_variance(n).map(|s| s.max(0.0).sqrt() * predicted.variance()),
    );
    let spread = (predicted.variance() / n).sqrt();
    row.z_mean = finite(row.mean.map(|mean| (mean - channel.truth.value) / spread));
    let testable = |kurtosis: &f64| *kurtosis > 1.0 + 1e-6 && kurtosis.is_finite();
    let kurtosis = predicted.kurtosis().filter(testable);
    let square = tally.mean_square().map(|square| square * unit * unit / predicted.variance());
    row.z_variance = finite(
        square
            .zip(kurtosis)
            .map(|(square, kurtosis)| (square - 1.0) / ((kurtosis - 1.0) / n).sqrt()),
    );
}

fn measure_lookups(row: &mut Row, prediction: &Prediction, drawn: &Drawn) {
    let n = drawn.lookups.draws as f64;
    let law = prediction.lookups.as_ref();
    let observed = drawn.lookups.moments().map(|m| m.mean);
    row.lookups_per_draw = observed.map(|mean| mean + law.map_or(0.0, |law| law.mean));
    if let Some(law) = law.filter(|law| law.variance > 0.0) {
        let deviation = (law.variance / n).sqrt();
        row.lookups_deviation = Some(deviation);
        row.z_lookups = observed.map(|mean| mean / deviation);
    }
    let fom = row.variance.zip(row.lookups_per_draw).map(|(v, m)| 1.0 / (v * m));
    row.fom = finite(fom.filter(|_| row.z_mean.is_some()));
}

/// A relative variance below this is rounding.
const CERTAIN: f64 = 1e-20;

/// A word as a shell reads it, whatever is in it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_./:@%+=-".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// The command that draws an experiment again, and writes nothing.
fn command(plan: &Plan, case: &PlannedCase, planned: &Planned) -> String {
    let case = case.case;
    // A built-in case has no file, and a file has no name that the command would know.
    let is_built_in = suite::find(&case.name).is_some_and(|source| source.path == case.path);
    let place = if is_built_in { case.name.clone() } else { case.path.display().to_string() };
    // Twins are numbered by the plan; a filter sees them all under one name.
    let estimator = planned.names.estimator.split(" #").next().unwrap_or_default();
    let Options { seed, alpha, fixed, strict, kernel, .. } = plan.options;
    let (place, filter) = (quoted(&place), quoted(&format!("*:{estimator}")));
    let draws = planned.draws;
    let mut command = format!(
        "trueflight check {place} --filter {filter} --seed {seed} --draws {draws} --verbose"
    );
    if alpha != Options::default().alpha {
        command = format!("{command} --alpha {alpha}");
    }
    if let Some(kernel) = kernel {
        command = format!("{command} --kernel {}", kernel.word());
    }
    for (flag, _) in [(" --fixed-draws", fixed), (" --strict", strict)].iter().filter(|f| f.1) {
        command.push_str(flag);
    }
    command
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

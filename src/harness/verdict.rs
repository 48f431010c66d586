//! From a plan, or from what a plan drew, to a record.

use fearless_simd::Level;
use rayon::prelude::*;

use super::drawn::{Drawn, Draws};
use super::normality::{Tails, needed};
use super::options::Options;
use super::plan::{MISS, Plan, Planned, PlannedCase};
use super::record::{
    Anatomy, CaseRecord, Finding, Gate, MeasuredPoint, Record, Results, Row, SCHEMA, Timing,
    Verdict,
};
use super::theory_rows::{finite, theory_rows};
use super::{curves, evaluate, suite, summary};
use crate::numeric::pack;
use crate::stats::Tally;
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
                row.reason = evaluate::untestable(planned, channel);
            }
            rows
        });
        rows.collect()
    };
    let mut record = record(plan, plan.cases.iter().map(|case| (rows(case), None, None)));
    for (case, planned_case) in record.results.cases.iter_mut().zip(&plan.cases) {
        let draws = planned_case.experiments.iter().flat_map(|planned| {
            let draws = planned.outcome.is_ok().then_some(planned.draws);
            std::iter::repeat_n(draws, planned.channels())
        });
        case.rows.iter_mut().zip(draws).for_each(|(row, draws)| row.draws = draws);
    }
    record
}

/// What theory says: the rows of a plan.
#[must_use]
pub fn predicted(plan: &Plan) -> Record {
    let rows = |case: &PlannedCase| -> Vec<Row> {
        case.experiments.iter().flat_map(|planned| theory_rows(case, planned)).collect()
    };
    record(plan, plan.cases.iter().map(|case| (rows(case), None, None)))
}

/// The same with the best constant σ̂ of each experiment and channel, which takes a hundred predictions.
#[must_use]
pub fn predicted_with_optima(plan: &Plan) -> Record {
    let mut record = predicted(plan);
    let cases = plan.cases.par_iter().map(|case| curves::best_of_each(case, plan.options.seed));
    let best: Vec<_> = cases.collect();
    for (found, (case, best)) in record.results.cases.iter_mut().zip(plan.cases.iter().zip(best)) {
        let of_rows = case.experiments.iter().zip(best).flat_map(|(planned, best)| {
            let channels = planned.channels();
            (0..channels).map(move |channel| best.get(channel).copied().flatten())
        });
        for (row, best) in found.rows.iter_mut().zip(of_rows) {
            let best = best.filter(|_| row.verdict.is_none());
            row.best_sampling = best.map(|best| best.sampling);
            row.best_fom = best.map(|best| best.figure_of_merit);
        }
    }
    record
}

/// What a plan drew, judged.
#[must_use]
pub fn judged(plan: &Plan, draws: &Draws, seconds: f64) -> Record {
    let pairs: Vec<_> = plan.cases.iter().zip(&draws.cases).collect();
    let findings = evaluate::run(plan, draws);
    let parts: Vec<_> = pairs
        .par_iter()
        .zip(&findings)
        .map(|((case, drawn), findings)| {
            let both = case.experiments.iter().zip(drawn.iter());
            let rows = both.clone().zip(findings).flat_map(|((planned, drawn), findings)| {
                drawn_rows(plan, case, planned, drawn, findings)
            });
            let rows: Vec<Row> = rows.collect();
            let sweep = curves::sweep(case.case, &plan.options, Some(plan.levels.z));
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
            std::iter::repeat_n((time, drawn.is_reused), planned.channels())
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
            row.not_normal = not_normal(row, prediction, drawn.lookups.draws);
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

/// The columns of z in a row that are not to be read as normal; the lookups are of so many draws.
fn not_normal(row: &Row, prediction: &Prediction, looked: u64) -> Vec<&'static str> {
    let n = row.draws.unwrap_or(0) as f64;
    let tails = Tails {
        kurtosis: row.predicted_kurtosis,
        eighth_moment_ratio: row.eighth_moment_ratio,
        rare_event_size: row.rare_event_size,
    };
    let of_lookups = prediction.lookups.as_ref().map(|law| needed(law.kurtosis, 1.0));
    let is_normal = of_lookups.is_some_and(|needed| looked as f64 >= needed);
    let all = [
        ("z_mean", row.z_mean, tails.has_normal_mean(n)),
        ("z_variance", row.z_variance, tails.has_normal_variance(n)),
        ("z_lookups", row.z_lookups, is_normal),
    ];
    all.into_iter().filter(|(_, z, is)| z.is_some() && !is).map(|(name, ..)| name).collect()
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

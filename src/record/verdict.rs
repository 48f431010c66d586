//! From a plan, or from what a plan drew, to a record.

use crate::draw::drawn::{Drawn, Draws};
use crate::plan::foreseen::Foreseen;
use crate::plan::{MISS, Plan, Planned, PlannedCase};
use crate::record::anatomy::anatomy;
use crate::record::curves;
use crate::record::evaluate;
use crate::record::measured::{measure, measure_lookups, not_normal};
use crate::record::qualify::explain_blocks;
use crate::record::repeat::{command, deciding, deciding_all};
use crate::record::summary;
use crate::record::theory_rows::{finite, theory_rows};
use crate::record::{
    Anatomy, CaseRecord, Finding, Gate, Record, Results, Row, SCHEMA, Sweep, Timing, Verdict,
};
use fearless_simd::Level;
use numeric::pack;
use theory::parallel;

/// What a plan would do: one row per experiment and channel, nothing drawn.
pub fn planned(plan: &Plan) -> Record {
    let rows = |case: &PlannedCase| -> Vec<Row> {
        let rows = case.experiments.iter().flat_map(|planned| {
            let mut rows = theory_rows(case, planned);
            for (channel, row) in
                rows.iter_mut().enumerate().filter(|(_, row)| row.verdict.is_none())
            {
                let foreseen = Foreseen::of(plan, case, planned, channel);
                (row.foreseen, row.needed_draws) = (foreseen.verdict, foreseen.needed);
                row.reason = foreseen.reason;
            }
            rows
        });
        rows.collect()
    };
    let mut record =
        record(plan, plan.cases.iter().map(|case| (rows(case), curves::axis(case.case), None)));
    for (case, planned_case) in record.results.cases.iter_mut().zip(&plan.cases) {
        let draws = planned_case.experiments.iter().flat_map(|planned| {
            let draws = planned.outcome.is_ok().then_some(planned.draws);
            std::iter::repeat_n(draws, planned.channels())
        });
        case.rows.iter_mut().zip(draws).for_each(|(row, draws)| row.draws = draws);
        let decide = deciding_all(plan, planned_case);
        let open = |row: &&mut Row| row.foreseen == Some(Verdict::Inconclusive);
        case.rows.iter_mut().filter(open).for_each(|row| row.decide.clone_from(&decide));
    }
    record
}

/// What theory says: the rows of a plan.
pub fn predicted(plan: &Plan) -> Record {
    let rows = |case: &PlannedCase| -> Vec<Row> {
        case.experiments.iter().flat_map(|planned| theory_rows(case, planned)).collect()
    };
    record(plan, plan.cases.iter().map(|case| (rows(case), curves::axis(case.case), None)))
}

/// The same with the best constant σ̂ of each experiment and channel, which takes a hundred predictions.
pub fn predicted_with_optima(plan: &Plan) -> Record {
    let mut record = predicted(plan);
    let best = parallel::map(&plan.cases, |case| curves::best_of_each(case, plan.options.seed));
    for (found, (case, best)) in record.results.cases.iter_mut().zip(plan.cases.iter().zip(best)) {
        let of_rows = case.experiments.iter().zip(best).flat_map(|(planned, best)| {
            let channels = planned.channels();
            (0..channels).map(move |channel| best.get(channel).copied().flatten())
        });
        for (row, best) in found.rows.iter_mut().zip(of_rows) {
            let best = best.filter(|_| row.verdict.is_none());
            row.best_sampling = best.map(|best| best.sampling);
            row.best_fom = finite(best.map(|best| best.figure_of_merit));
            best.map_or("", |best| best.kind.words()).clone_into(&mut row.best_kind);
            row.best_limit = best.and_then(|best| best.kind.limit());
        }
    }
    record
}

/// What a plan drew, judged. The lines of plots are left out, see [`add_curves`].
pub fn judged(plan: &Plan, draws: &Draws, seconds: f64) -> Record {
    let findings = evaluate::run(plan, draws);
    let found: Vec<_> = plan.cases.iter().zip(&draws.cases).zip(&findings).collect();
    let parts = parallel::map(&found, |&((case, drawn), findings)| {
        let both = case.experiments.iter().zip(drawn.iter());
        let rows = both.clone().zip(findings).flat_map(|((planned, drawn), findings)| {
            drawn_rows(plan, case, planned, drawn, findings)
        });
        let rows: Vec<Row> = rows.collect();
        let z_limit = Some(plan.levels.z);
        let sweep = curves::axis(case.case).map(|sweep| Sweep { z_limit, ..sweep });
        let anatomy = both.clone().find_map(|(planned, drawn)| anatomy(case, planned, drawn));
        (rows, sweep, anatomy)
    });
    let mut record = record(plan, parts.into_iter());
    record.results.cut_by_time = draws.cut_by_time;
    record.results.cut_by_budget = draws.cut_by_budget;
    summary::complete(&mut record.results);
    record.timing.seconds = seconds;
    for ((case, drawn), timing) in plan.cases.iter().zip(&draws.cases).zip(0..) {
        let both = case.experiments.iter().zip(drawn.iter());
        let rows = both.flat_map(|(planned, drawn)| {
            let time = planned.outcome.is_ok().then_some(drawn.seconds);
            std::iter::repeat_n((time, drawn.is_reused), planned.channels())
        });
        (record.timing.rows[timing], record.timing.reused[timing]) = rows.unzip();
    }
    record
}

/// Adds the theory's lines along sweeps, which plots show.
pub fn add_curves(plan: &Plan, record: &mut Record) {
    let found = parallel::map(&plan.cases, |case| curves::curves(case.case, plan.options.seed));
    for (case, curves) in record.results.cases.iter_mut().zip(found) {
        if let Some(sweep) = &mut case.sweep {
            sweep.curves = curves;
        }
    }
}

type Part = (Vec<Row>, Option<Sweep>, Option<Anatomy>);

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
            draws_per_ray: Some(planned.case.draws_per_ray),
            visible_bias: None,
            pace: None,
            rows,
            sweep,
            anatomy,
            facts: planned.case.scenario.facts(),
            notes: planned.case.scenario.notes(),
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
            measure_lookups(row, prediction, drawn, planned.draws_per_ray);
            row.not_normal = not_normal(row, prediction, drawn.lookups.draws);
        }
        row.p_law = findings.iter().filter_map(|finding| finding.p).reduce(f64::min);
        let about =
            |finding: &&Finding| finding.channel.is_empty() || finding.channel == channel.name;
        row.findings = findings.iter().filter(about).cloned().collect();
        explain_blocks(&mut row.findings);
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
        if verdict == Verdict::Inconclusive {
            row.decide = deciding(plan, case, planned, findings);
        }
    }
    rows
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

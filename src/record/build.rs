//! Builds the record of a plan, of its predictions, or of its judged draws.

use crate::draw::drawn::{Drawn, Draws};
use crate::plan::foreseen::Foreseen;
use crate::plan::{MISS, Plan, PlannedCase};
use crate::record::curves;
use crate::record::evaluate;
use crate::record::qualify::explain_blocks;
use crate::record::repeat::{command, deciding, deciding_all};
use crate::record::summary;
use crate::record::theory;
use crate::record::{
    Anatomy, CaseRecord, ExperimentRecord, Finding, Gate, Record, Results, SCHEMA, Spent, Sweep,
    Timing, Verdict,
};
use ::theory::parallel;
use fearless_simd::Level;
use numeric::pack;

/// Builds the record of a plan before the first draw: with the numbers of draws, and the verdicts that are certain already.
pub fn planned(plan: &Plan) -> Record {
    record(plan, |_, case| {
        let decide = deciding_all(plan, case);
        let experiments = (0..case.experiments.len()).map(|index| {
            let planned = &case.experiments[index];
            let mut record = theory::predicted(case, index);
            record.draws = planned.outcome.is_ok().then_some(planned.draws);
            for (channel, values) in record.channels.iter_mut().enumerate() {
                if values.verdict.is_some() {
                    continue;
                }
                let foreseen = Foreseen::of(plan, case, planned, channel);
                (values.foreseen, values.needed_draws) = (foreseen.verdict, foreseen.needed);
                values.reason = foreseen.reason;
                if values.foreseen == Some(Verdict::Inconclusive) {
                    values.decide.clone_from(&decide);
                }
            }
            record
        });
        Part::of(experiments.collect(), case)
    })
}

/// Builds the record of the predictions of a plan.
pub fn predicted(plan: &Plan) -> Record {
    record(plan, |_, case| {
        let experiments = 0..case.experiments.len();
        Part::of(experiments.map(|index| theory::predicted(case, index)).collect(), case)
    })
}

/// Builds the record of the predictions of a plan, with the best constant σ̂ of each experiment and channel, which takes
/// a hundred predictions.
pub fn predicted_with_optima(plan: &Plan) -> Record {
    record(plan, |_, case| {
        let best = curves::best_of_each(case, plan.options.seed);
        let experiments = best.into_iter().enumerate().map(|(index, best)| {
            let mut record = theory::predicted(case, index);
            for (channel, values) in record.channels.iter_mut().enumerate() {
                let best = best.get(channel).copied().flatten();
                values.best = best.filter(|_| values.verdict.is_none()).map(curves::named_best);
            }
            record
        });
        Part::of(experiments.collect(), case)
    })
}

/// Builds the record of what a plan drew, judged. The lines of plots are left out, see [`add_curves`].
pub fn judged(plan: &Plan, draws: &Draws, seconds: f64) -> Record {
    let findings = evaluate::run(plan, draws);
    let mut record = record(plan, |number, case| {
        let found = draws.cases[number].iter().zip(&findings[number]).enumerate();
        let experiments = found.map(|(i, (drawn, found))| experiment(plan, case, i, drawn, found));
        let z_limit = Some(plan.levels.z);
        let part = Part::of(experiments.collect(), case);
        let sweep = part.sweep.map(|sweep| Sweep { z_limit, ..sweep });
        let drawn = case.experiments.iter().zip(&draws.cases[number]);
        let anatomy = drawn.into_iter().find_map(|(p, drawn)| curves::anatomy(case, p, drawn));
        Part { sweep, anatomy, ..part }
    });
    record.results.cut_by_time = draws.cut_by_time;
    record.results.cut_by_budget = draws.cut_by_budget;
    summary::complete(&mut record.results);
    record.timing.seconds = seconds;
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

/// The parts of a case's record that differ between plans, predictions and runs.
struct Part {
    experiments: Vec<ExperimentRecord>,
    sweep: Option<Sweep>,
    anatomy: Option<Anatomy>,
}

impl Part {
    /// The experiments with the axis of the sweep.
    fn of(experiments: Vec<ExperimentRecord>, case: &PlannedCase) -> Self {
        Self { experiments, sweep: curves::axis(case.case), anatomy: None }
    }
}

fn record(plan: &Plan, part: impl Fn(usize, &PlannedCase) -> Part + Sync) -> Record {
    let numbered: Vec<(usize, &PlannedCase)> = plan.cases.iter().enumerate().collect();
    let cases = parallel::map(&numbered, |&(number, planned)| {
        let Part { experiments, sweep, anatomy } = part(number, planned);
        let mut case = CaseRecord {
            name: planned.case.name.clone(),
            path: planned.case.path.display().to_string(),
            title: planned.case.title.clone(),
            problem: planned.case.problem.clone(),
            medium: planned.case.scenario.medium().to_owned(),
            draws_per_ray: Some(planned.case.draws_per_ray),
            visible_bias: None,
            pace: None,
            experiments,
            sweep,
            anatomy,
            facts: planned.case.scenario.facts(),
            notes: planned.case.scenario.notes(),
        };
        case.name_experiments();
        case
    });
    let timing = Timing {
        threads: rayon::current_num_threads(),
        level: pack::word(Level::new()),
        seconds: 0.0,
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

/// The experiment at an index of a case, with its draws and the findings of its checks.
fn experiment(
    plan: &Plan,
    case: &PlannedCase,
    index: usize,
    drawn: &Drawn,
    findings: &[Finding],
) -> ExperimentRecord {
    let planned = &case.experiments[index];
    let mut record = theory::predicted(case, index);
    let seconds = planned.outcome.is_ok().then_some(drawn.seconds);
    record.spent = Spent { seconds, is_reused: drawn.is_reused };
    if planned.outcome.is_err() {
        return record;
    }
    record.command = command(plan, case, planned);
    record.stream = Some(planned.address.experiment);
    record.drawn = Some(drawn.draws);
    record.p_law = findings.iter().filter_map(|finding| finding.p).reduce(f64::min);
    theory::measure(&mut record, planned, drawn);
    record.findings = findings.to_vec();
    explain_blocks(&mut record.findings);
    for finding in &mut record.findings {
        let channel = record.channels.iter().find(|channel| finding.is_about(&channel.channel));
        finding.z = match finding.check.as_str() {
            "mean" => channel.and_then(|channel| channel.z_mean),
            "variance" => channel.and_then(|channel| channel.z_variance),
            "lookups" => record.z_lookups,
            _ => None,
        };
    }
    for values in &mut record.channels {
        let found = record.findings.iter().filter(|finding| finding.is_about(&values.channel));
        let found: Vec<&Finding> = found.collect();
        let mean = found.iter().find(|finding| finding.check == "mean");
        values.detectable_bias = mean.and_then(|mean| mean.gate).map(|gate| gate.tolerance);
        let (verdict, reason) = worst(&found);
        (values.verdict, values.reason) = (Some(verdict), reason);
        if verdict == Verdict::Inconclusive {
            values.decide = deciding(plan, case, planned, findings);
        }
    }
    record
}

/// The worst verdict, with every reason of it.
fn worst(findings: &[&Finding]) -> (Verdict, String) {
    let verdict = Verdict::worst(findings.iter().map(|finding| finding.verdict));
    let mut reasons: Vec<&str> = Vec::new();
    for finding in findings.iter().filter(|finding| finding.verdict == verdict) {
        if !finding.reason.is_empty() && !reasons.contains(&finding.reason.as_str()) {
            reasons.push(&finding.reason);
        }
    }
    (verdict, reasons.join("; "))
}

//! Builds the record of a plan, of its predictions, or of its judged draws.

use crate::draw::block::Draws;
use crate::plan::levels::Foreseen;
use crate::plan::{Plan, PlannedCase};
use crate::record::evaluate::{self, Judged};
use crate::record::repeat::{command, deciding, deciding_all};
use crate::record::{
    CaseRecord, ExperimentRecord, Finding, Gate, Record, Results, Row, SCHEMA, Spent, Suspect,
    Timing, Verdict, curves, theory,
};
use ::theory::parallel;
use fearless_simd::Level;
use gate::CheckId;
use gate::stats::gate::TYPICAL;
use gate::stats::multiplicity;
use gate::stats::verdict::MISS;
use numeric::pack;

/// Builds the record of a plan before the first draw: with the numbers of draws, and the verdicts that are certain already.
pub fn planned(plan: &Plan) -> Record {
    let cases = parallel::map(&plan.cases, |case| {
        let decide = deciding_all(plan, case);
        let experiments = case.experiments.iter().map(|planned| {
            let mut record = theory::predicted(case, planned);
            record.draws = planned.outcome.is_ok().then_some(planned.draws);
            for (channel, values) in record.channels.iter_mut().enumerate() {
                if values.verdict.is_some() {
                    continue;
                }
                values.foreseen = Foreseen::of(planned, channel);
                if values.foresees(Verdict::Inconclusive) {
                    values.decide.clone_from(&decide);
                }
            }
            record
        });
        case_record(case, experiments.collect())
    });
    record(plan, cases)
}

/// Builds the record of the predictions of a plan.
pub fn predicted(plan: &Plan) -> Record {
    let cases = parallel::map(&plan.cases, |case| {
        let experiments = case.experiments.iter().map(|planned| theory::predicted(case, planned));
        case_record(case, experiments.collect())
    });
    record(plan, cases)
}

/// Builds the record of the predictions of a plan, with the best constant σ̂ of each experiment and channel, which takes
/// a hundred predictions.
pub fn predicted_with_optima(plan: &Plan) -> Record {
    let cases = parallel::map(&plan.cases, |case| {
        let best = curves::best_of_each(case, plan.options.seed);
        let experiments = best.into_iter().map(|(planned, best)| {
            let mut record = theory::predicted(case, planned);
            for (channel, values) in record.channels.iter_mut().enumerate() {
                let best = best.get(channel).copied().flatten();
                values.best = best.filter(|_| values.verdict.is_none()).map(curves::named_best);
            }
            record
        });
        case_record(case, experiments.collect())
    });
    record(plan, cases)
}

/// Builds the record of the draws of a plan, judged. The curves of plots are left out, see [`add_curves`].
pub fn judged(plan: &Plan, draws: &Draws, seconds: f64) -> Record {
    let judged = evaluate::run(plan, draws);
    let of_cases = judged.chunk_by(|a, b| a.of.planned.id.case == b.of.planned.id.case);
    let cases = parallel::map(&of_cases.collect::<Vec<_>>(), |judged| {
        let experiments = judged.iter().map(|one| experiment(plan, one));
        let mut case = case_record(judged[0].of.case, experiments.collect());
        case.anatomy = judged.iter().find_map(|one| curves::anatomy(one.of));
        if let Some(sweep) = &mut case.sweep {
            sweep.z_limit = Some(plan.levels.z);
        }
        case.visible_bias = visible_bias(&case);
        case.pace = pace(&case);
        case
    });
    let mut record = record(plan, cases);
    record.results.cut_by_time = draws.cut_by_time;
    record.results.cut_by_budget = draws.cut_by_budget;
    record.results.gate.variance_assumed = judged.iter().map(Judged::assumed).sum();
    complete(&mut record.results);
    record.timing.seconds = seconds;
    record
}

/// Adds the curves along sweeps that theory predicts, for plots.
pub fn add_curves(plan: &Plan, record: &mut Record) {
    parallel::change(&mut record.results.cases, |case| {
        let planned = plan.cases.iter().find(|planned| planned.case.name == case.name);
        if let (Some(planned), Some(sweep)) = (planned, &mut case.sweep) {
            sweep.curves = curves::curves(planned.case, plan.options.seed);
        }
    });
}

fn case_record(
    PlannedCase { case, .. }: &PlannedCase,
    experiments: Vec<ExperimentRecord>,
) -> CaseRecord {
    let mut record = CaseRecord {
        name: case.name.clone(),
        path: case.path.display().to_string(),
        title: case.title.clone(),
        problem: case.problem.clone(),
        medium: case.scenario.medium().to_owned(),
        draws_per_ray: case.draws_per_ray,
        experiments,
        sweep: curves::axis(case),
        facts: case.scenario.body().contents(),
        notes: case.scenario.notes(),
        ..CaseRecord::default()
    };
    record.name_experiments();
    record
}

fn record(plan: &Plan, cases: Vec<CaseRecord>) -> Record {
    let timing = Timing {
        threads: rayon::current_num_threads(),
        level: pack::word(Level::new()),
        ..Timing::default()
    };
    let levels = &plan.levels;
    let gate = Gate {
        scalars: levels.scalars,
        laws: levels.distributions,
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
                  draw j of a block from lane j mod 16"
                .to_owned(),
        gate,
        cut_by_time: false,
        cut_by_budget: false,
        cases,
    };
    Record { results, timing, comparison: None }
}

/// Returns the record of an experiment with its draws and the findings of its checks.
fn experiment(plan: &Plan, judged: &Judged) -> ExperimentRecord {
    let (of, findings) = (judged.of, judged.findings.clone());
    let (case, planned, drawn) = (of.case, of.planned, &of.drawn);
    let mut record = theory::predicted(case, planned);
    let seconds = planned.outcome.is_ok().then_some(drawn.seconds);
    record.spent = Spent { seconds, is_reused: drawn.is_reused };
    if planned.outcome.is_err() {
        return record;
    }
    record.command = command(plan, case, planned);
    record.stream = Some(planned.address.experiment);
    record.drawn = Some(drawn.draws);
    record.p_law = findings.iter().filter_map(|finding| finding.p).reduce(f64::min);
    theory::measure(&mut record, of);
    record.findings = findings;
    for finding in &mut record.findings {
        let channel = record.channels.iter().find(|channel| finding.is_about(&channel.channel));
        finding.z = match finding.check {
            CheckId::Mean => channel.and_then(|channel| channel.z_mean),
            CheckId::Variance => channel.and_then(|channel| channel.z_variance),
            CheckId::Lookups => record.z_lookups,
            _ => None,
        };
    }
    for values in &mut record.channels {
        let result = || record.findings.iter().filter(|finding| finding.is_about(&values.channel));
        let mean = result().find(|finding| finding.check == CheckId::Mean);
        values.detectable_bias = mean.and_then(|mean| mean.gate).map(|gate| gate.tolerance);
        let verdict = Verdict::worst(result().map(|finding| finding.verdict));
        values.verdict = Some(verdict);
        if verdict == Verdict::Inconclusive {
            values.decide = deciding(plan, case, planned, &record.findings);
        }
    }
    record
}

/// Fills in the numbers that depend on the whole run.
fn complete(results: &mut Results) {
    let (alpha, cases, gate) = (results.alpha, &results.cases, &mut results.gate);
    let suspects: Vec<Suspect> = cases
        .iter()
        .flat_map(|case| scalars(case).map(|(row, finding)| suspect(case, &row, finding)))
        .collect();
    let ln_e: Vec<f64> = suspects.iter().map(|suspect| suspect.ln_e).collect();
    if !ln_e.is_empty() {
        gate.ln_mean_e = Some(multiplicity::mean_e_value(&ln_e)).filter(|e| e.is_finite());
        let strongest = ln_e.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        gate.smallest_margin = Some(gate.ln_e_limit - strongest).filter(|m| m.is_finite());
    }
    let listed = multiplicity::e_benjamini_hochberg(&ln_e, alpha);
    gate.triage = listed.into_iter().map(|index| suspects[index].clone()).collect();
    let means = || cases.iter().flat_map(CaseRecord::rows).flat_map(|row| row.findings());
    let passed = |finding: &&Finding| {
        finding.check == CheckId::Mean && finding.verdict == Verdict::Pass && !finding.expects_bias
    };
    let biases = means().filter(passed).filter_map(|finding| Some(finding.gate?.tolerance));
    gate.worst_bias = biases.reduce(f64::max);
}

/// Returns the scalars of a case with their rows; those of a whole experiment are in the first of its rows.
fn scalars(case: &CaseRecord) -> impl Iterator<Item = (Row<'_>, &Finding)> {
    // Draws that two experiments share count once.
    let own = case.rows().filter(|row| row.experiment.same_as.is_none());
    own.flat_map(|row| {
        let scalars =
            row.own_findings().filter(|result| result.gate.is_some() && !result.expects_bias);
        scalars.map(move |finding| (row, finding))
    })
}

fn suspect(case: &CaseRecord, row: &Row, finding: &Finding) -> Suspect {
    let mut experiment = row.experiment.label.clone();
    if let Some(swept) = row.experiment.swept() {
        experiment = format!("{experiment} at {swept}");
    }
    if !finding.channel.is_empty() {
        experiment = format!("{experiment}, {}", finding.channel);
    }
    let ln_e = finding.gate.map_or(0.0, |gate| gate.ln_e);
    Suspect { case: case.name.clone(), experiment, check: finding.check, ln_e }
}

/// Returns the range of ε over the means for which a pass was promised.
fn visible_bias(case: &CaseRecord) -> Option<[f64; 2]> {
    let means = case.rows().flat_map(|row| row.findings()).filter(|f| f.check == CheckId::Mean);
    let promised = means.filter_map(|finding| finding.gate.filter(|gate| gate.needed.is_none()));
    let tolerances: Vec<f64> = promised.map(|gate| gate.tolerance).collect();
    let minimum = tolerances.iter().copied().reduce(f64::min)?;
    let range = [minimum, tolerances.iter().copied().fold(minimum, f64::max)];
    Some(range).filter(|range| range.iter().all(|end| end.is_finite()))
}

/// Returns [`CaseRecord::pace`].
fn pace(case: &CaseRecord) -> Option<f64> {
    let passed = scalars(case).filter(|(_, finding)| finding.verdict == Verdict::Pass);
    let (taken, typical) = passed.filter_map(|(_, finding)| finding.gate).fold(
        (0.0, 0.0),
        |(taken, typical), gate| {
            let unit = gate.variance / (gate.tolerance * gate.tolerance);
            (taken + gate.draws as f64, typical + TYPICAL * unit)
        },
    );
    (typical > 0.0).then(|| taken / typical)
}

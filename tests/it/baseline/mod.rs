//! Stored runs: changes that are flagged against them, changes that are not, and evidence that adds up over runs.

mod left_out;

use serde_json::Value;
use tempfile::TempDir;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::draw::run;
use trueflight::estimators::Kernel;
use trueflight::estimators::{DrawBuffer, Experiment};
use trueflight::gate::CheckId;
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::record::Record;
use trueflight::record::baseline::{Baseline, BaselineEntry, BaselineError};
use trueflight::record::baseline::{
    ComparedQuantity, Comparison, ComparisonLevels, Sequel, compare,
};
use trueflight::record::build;
use trueflight::rng::Streams;

use crate::common::Nothing;
use crate::common::place::{self, Place};

const CASE: &str = "title = \"a case\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sampling.constant.value = 1
estimators = [{ woodcock = {} }, { ratio = {} }]
";

const RULES: ComparisonLevels = ComparisonLevels { alpha: 1e-3, time_tolerance: None };

fn case() -> Case {
    let source = CaseText { name: "case".into(), path: "case.toml".into(), text: CASE.into() };
    Case::read(&source).expect("no mistakes")
}

fn options(seed: u64) -> Options {
    Options { seed, draws: Amount::Exactly(200_000), alpha: 1e-6, ..Options::default() }
}

fn record(plan: &Plan) -> Record {
    build::judged(plan, &run::draw(plan, &|_| {}), 0.0)
}

fn baseline(seed: u64) -> Baseline {
    let cases = [case()];
    Baseline::of(&record(&Plan::new(&cases, &options(seed))), &cases, "program")
}

/// Draws with a constant added to each.
struct Biased(Box<dyn Experiment>, f64);

impl Experiment for Biased {
    fn fill_by(&self, kernel: Kernel, rng: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        self.0.fill_by(kernel, rng, count, buffer);
        buffer.values.iter_mut().flatten().for_each(|x| *x += self.1);
    }
}

fn quantities(comparison: &Comparison) -> Vec<(ComparedQuantity, bool)> {
    comparison.changes.iter().map(|change| (change.quantity, change.is_regression)).collect()
}

#[test]
fn a_stored_run_comes_back() {
    let folder = TempDir::new().expect("a folder");
    let path = Baseline::path(&folder.path().join("new"), "main-1.0").expect("a name");
    let run = baseline(1);
    assert_eq!(run.entries.len(), 2);
    assert_eq!(run.entries[1].id.to_string(), "case:ratio, σ\u{302} 1");
    run.write(&path).expect("written");
    let read = Baseline::read(&path).expect("read");
    let (comparison, next) = compare("main", &read, &run, &RULES);
    assert_eq!(comparison.sequel, Sequel::SameSeed);
    assert!(!comparison.fails() && comparison.changes.is_empty(), "{comparison:?}");
    assert_eq!(comparison.compared, 4);
    assert_eq!(next.seeds, [1]);
    // Only the baseline is left.
    assert_eq!(std::fs::read_dir(path.parent().expect("a folder")).expect("listed").count(), 1);
}

#[test]
fn doctored_baselines_are_flagged_and_equal_runs_are_not() {
    let (stored, run) = (baseline(1), baseline(2));
    let (comparison, _) = compare("main", &stored, &run, &RULES);
    assert!(!comparison.fails() && comparison.changes.is_empty(), "{comparison:?}");
    assert_eq!(comparison.sequel, Sequel::Run(2));

    let mut better = stored.clone();
    better.entries[1].variance = better.entries[1].variance.map(|v| 0.5 * v);
    better.entries[0].lookups = better.entries[0].lookups.map(|n| 0.9 * n);
    let (comparison, _) = compare("main", &better, &run, &RULES);
    assert!(comparison.fails());
    assert_eq!(
        quantities(&comparison),
        [(ComparedQuantity::Lookups, true), (ComparedQuantity::Variance, true)]
    );
    let change = &comparison.changes[1];
    let [low, high] = change.interval.expect("an interval");
    assert!(low > 1.8 && low < change.ratio && change.ratio < high && high < 2.2, "{change:?}");
    assert!(change.command.contains("--filter") && change.id.experiment.estimator.name == "ratio");

    let mut worse = stored.clone();
    worse.entries[1].variance = worse.entries[1].variance.map(|v| 2.0 * v);
    let (comparison, _) = compare("main", &worse, &run, &RULES);
    assert!(!comparison.fails());
    assert_eq!(quantities(&comparison), [(ComparedQuantity::Variance, false)]);
}

#[test]
fn a_time_fails_beyond_its_tolerance_only() {
    let (mut stored, mut run) = (baseline(1), baseline(1));
    for (before, now, expected) in
        [(1.0, 1.2, None), (1.0, 1.3, Some(true)), (1.3, 1.0, Some(false))]
    {
        stored.entries[0].seconds = Some(before);
        run.entries[0].seconds = Some(now);
        run.entries[0].drawn = stored.entries[0].drawn;
        let rules = ComparisonLevels { time_tolerance: Some(0.25), ..RULES };
        let (comparison, _) = compare("main", &stored, &run, &rules);
        let times =
            comparison.changes.iter().filter(|change| change.quantity == ComparedQuantity::Time);
        let of_first = times.filter(|change| change.id == run.entries[0].id);
        let found: Vec<bool> = of_first.map(|change| change.is_regression).collect();
        assert_eq!(found, expected.into_iter().collect::<Vec<_>>(), "{before} {now}");
    }
}

#[test]
fn what_only_one_side_has_is_listed() {
    let (stored, mut run) = (baseline(1), baseline(2));
    "new".clone_into(&mut run.entries[0].id.channel);
    run.entries[1].case = "another text".into();
    let (comparison, next) = compare("main", &stored, &run, &RULES);
    assert_eq!(comparison.added, [run.entries[0].id.clone()]);
    assert_eq!(comparison.missing, [stored.entries[0].id.clone()]);
    assert_eq!(comparison.rewritten, [stored.entries[1].id.clone()]);
    assert_eq!(comparison.compared, 0);
    assert_eq!(next.entries, run.entries, "a rewritten case keeps nothing");
}

#[test]
fn what_a_later_run_leaves_out_is_kept_at_the_higher_limit() {
    let (mut stored, mut run) = (baseline(1), baseline(2));
    run.entries.truncate(1);
    stored.ln_e_limit = run.ln_e_limit + 1.0;
    let (comparison, next) = compare("main", &stored, &run, &RULES);
    assert_eq!(comparison.missing, [stored.entries[1].id.clone()]);
    assert_eq!(next.entries[1], stored.entries[1]);
    assert_eq!(next.ln_e_limit, stored.ln_e_limit);
}

#[test]
fn variances_without_a_normal_law_are_not_compared() {
    let (mut stored, run) = (baseline(1), baseline(2));
    let compared = |stored: &Baseline| compare("main", stored, &run, &RULES).0;
    let all = compared(&stored);
    let n = stored.entries[1].draws as f64;
    for doctor in [
        |entry: &mut BaselineEntry, n: f64| entry.eighth_moment_ratio = Some(0.02 * n),
        |entry: &mut BaselineEntry, n: f64| entry.rare_event_size = Some(0.2 * n),
        |entry: &mut BaselineEntry, n: f64| entry.kurtosis = Some(1.0 + 50.0 / n),
        |entry: &mut BaselineEntry, n: f64| entry.kurtosis = Some(1.0 + 0.02 * n),
    ] {
        let honest = stored.entries[1].clone();
        doctor(&mut stored.entries[1], n);
        let now = compared(&stored);
        assert_eq!((now.compared, now.blunt), (all.compared - 1, all.blunt + 1));
        stored.entries[1] = honest;
    }
}

#[test]
fn a_small_bias_adds_up_over_runs() {
    let cases = [case()];
    let mut failed_after = None;
    let mut stored: Option<Baseline> = None;
    let mut limit = 0.0;
    for seed in 1..=12 {
        let mut plan = Plan::new(&cases, &Options { fixed: true, ..options(seed) });
        // A bias of three quarters of the tolerance.
        let planned = &mut plan.cases[0].experiments[1];
        let (_, scalar) = planned.scalars().next().expect("the mean");
        let bias = 0.75 * scalar.planned.design.tolerance * (-1f64).exp();
        if let Ok(ready) = planned.outcome.as_mut() {
            let honest = std::mem::replace(&mut ready.experiment, Box::new(Nothing));
            ready.experiment = Box::new(Biased(honest, bias));
        }
        limit = plan.levels.ln_fail;
        let found = record(&plan);
        let mean = &found.results.cases[0].experiments[1].findings[0];
        let mean = mean.gate.expect("a scalar");
        assert!(mean.ln_e < limit, "seed {seed}: one run is enough, {} {limit}", mean.ln_e);
        let run = Baseline::of(&found, &cases, "program");
        let Some(before) = stored.take() else {
            stored = Some(run);
            continue;
        };
        let (comparison, next) = compare("main", &before, &run, &RULES);
        assert_eq!(next.seeds.len() as u64, seed);
        if !comparison.drifts.is_empty() {
            let drift = &comparison.drifts[0];
            assert!(
                drift.id.experiment.estimator.name == "ratio" && drift.check == CheckId::Mean,
                "{drift:?}"
            );
            assert!(comparison.fails() && drift.ln_e >= limit);
            failed_after = Some(seed);
            break;
        }
        stored = Some(next);
    }
    assert!(failed_after.is_some_and(|runs| runs > 1), "{failed_after:?} {stored:?} {limit}");
}

#[test]
fn another_program_and_the_same_seed_multiply_nothing() {
    let (stored, mut run) = (baseline(1), baseline(2));
    run.executable = "another".into();
    let (comparison, next) = compare("main", &stored, &run, &RULES);
    assert_eq!(comparison.sequel, Sequel::OtherProgram);
    assert_eq!(next, run);
    let mut twice = stored.clone();
    twice.seeds.push(2);
    run.executable.clone_from(&stored.executable);
    let (comparison, next) = compare("main", &twice, &run, &RULES);
    assert_eq!(comparison.sequel, Sequel::SameSeed);
    assert_eq!(next.seeds, [1, 2]);
    assert_eq!(next.entries[0].checks, stored.entries[0].checks);
}

#[test]
fn what_is_no_baseline_is_an_error_with_its_cure() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("x.json");
    let read = || Baseline::read(&path).expect_err("an error");
    assert!(matches!(read(), BaselineError::Missing(_)));
    for text in ["", "no json", "{}", "[]", "{\"schema\": 1, \"seeds\": [1]}"] {
        std::fs::write(&path, text).expect("written");
        assert!(matches!(read(), BaselineError::Broken { .. }), "{text}");
    }
    let whole = serde_json::to_string(&baseline(1)).expect("JSON");
    std::fs::write(&path, &whole[..whole.len() / 2]).expect("written");
    assert!(matches!(read(), BaselineError::Broken { .. }));
    std::fs::write(&path, whole.replace("\"schema\":1", "\"schema\":9")).expect("written");
    assert!(matches!(read(), BaselineError::Schema { actual: 9, .. }));
    assert!(read().to_string().contains("--save-baseline"));
    for name in ["", "a/b", "..", ".x", "a b"] {
        assert!(
            matches!(Baseline::path(folder.path(), name), Err(BaselineError::Name(_))),
            "{name}"
        );
    }
}

/// Returns the command of a run with some more words.
fn usual(more: &str) -> String {
    format!("run case.toml --draws 400000 --alpha 1e-6 --time-tolerance inf {more}")
}

/// Returns the output of a command that must end with this exit code.
fn said(place: &Place, arguments: &str, expected: i32) -> String {
    let output = place.command(arguments).env("COLUMNS", "400").output().expect("it runs");
    let text = place::said(&output);
    assert_eq!(place::code(&output), expected, "{text}");
    text
}

#[test]
fn the_command_stores_compares_and_accumulates() {
    let place = Place::new(&[("case.toml", CASE)]);
    let file = place.path().join("baselines/main.json");
    let text = said(&place, &usual("--save-baseline main"), 0);
    assert!(text.contains("baseline main stored"), "{text}");
    let text = said(&place, &usual("--baseline main"), 0);
    assert!(text.contains("this seed already") && text.contains("no change"), "{text}");
    let text = said(&place, &usual("--baseline main --save-baseline main --seed 2"), 0);
    assert!(text.contains("e-values multiplied"), "{text}");
    let read = || -> Value {
        serde_json::from_slice(&std::fs::read(&file).expect("a file")).expect("JSON")
    };
    let mut tree = read();
    assert_eq!(tree["seeds"], serde_json::json!([1, 2]));
    let variance = tree["entries"][1]["variance"].as_f64().expect("a number");
    tree["entries"][1]["variance"] = (0.5 * variance).into();
    std::fs::write(&file, tree.to_string()).expect("written");
    let both = "--baseline main --save-baseline main --seed 3";
    let text = said(&place, &usual(both), 1);
    assert!(text.contains("REGRESSION") && text.contains("not stored"), "{text}");
    assert_eq!(read(), tree, "what became worse is not stored");
    let text = said(&place, &usual("--baseline main --quiet"), 1);
    assert!(text.is_empty(), "{text}");
}

#[test]
fn a_bad_baseline_is_known_before_the_drawing() {
    let place = Place::new(&[("case.toml", CASE), ("bad.json", "{")]);
    for (arguments, cure) in [
        ("--baseline nowhere", "--save-baseline"),
        ("--baselines . --baseline bad", "--save-baseline"),
        ("--baseline a/b", "letters"),
        ("--baselines case.toml --save-baseline x", "--baselines"),
    ] {
        let begin = std::time::Instant::now();
        let text = said(&place, &format!("run case.toml --draws 1000000000 {arguments}"), 2);
        assert!(text.contains(cure), "{text}");
        assert!(begin.elapsed().as_secs() < 20, "it drew first");
    }
}

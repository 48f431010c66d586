//! `trueflight bench`: figures that agree with each other, results that do not depend on time or
//! threads, exit codes, and stored benches.

use crate::common::place::{Place, code, stdout};
use crate::common::{case, options};
use trueflight::bench::record::{Bench, BenchRow, ERRORS};
use trueflight::bench::{Amounts, measure};
use trueflight::case::Case;
use trueflight::numeric::pack;
use trueflight::plan::Plan;

const CASE: &str = "title = \"a case\"
[problem.transmittance]
medium.piecewise-constant = { breaks = [0, 1, 2], values = [0.2, 0.8] }
span = [0, 2]
sweep.sampling.values = [0.5, 1]
estimators = [{ woodcock = {} }, { ratio = {} }, { regular = {} }]
";

const CURVE: &str = "title = \"a curve\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
distances = 2
sampling.constant.value = 1
estimators = [{ double = {} }]
";

const BIASED: &str = "title = \"a bias\"
expect = \"biased\"
[problem.transmittance]
medium.exponential = { extinction = 1.0, rate = 1.0 }
span = [0, 2]
estimators = [{ ray-marching = { steps = 2 } }]
";

fn bench(cases: &[Case], threads: usize) -> Bench {
    let plan = Plan::new(cases, &options(1, 10_000));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let amounts = Amounts { draws: 10_000, rounds: 3, level: fearless_simd::Level::new() };
    pool.install(|| measure(&plan, amounts, &|_| {}))
}

fn rows(bench: &Bench) -> impl Iterator<Item = &BenchRow> {
    bench.cases.iter().flat_map(|case| &case.rows)
}

fn near(found: f64, expected: f64) {
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} is not {expected}");
}

#[test]
fn the_figures_of_a_row_agree_with_each_other() {
    let found = bench(&[case("case", CASE)], 1);
    for row in rows(&found).filter(|row| row.fom.is_some()) {
        let times = row.times.as_ref().expect("times");
        let seconds = times.ns_per_draw.median * 1e-9;
        let (variance, truth) =
            (row.predicted_variance.expect("theory"), row.truth.expect("truth"));
        let lookups = row.predicted_lookups.expect("theory");
        near(times.draws_per_second, 1.0 / seconds);
        near(times.ns_per_lookup.expect("lookups"), times.ns_per_draw.median / lookups);
        near(times.efficiency.expect("a variance"), 1.0 / (variance * seconds));
        near(times.ttuv().expect("a variance"), variance * seconds);
        near(row.fom.expect("lookups"), 1.0 / (variance * lookups));
        for (time, error) in times.seconds_to.expect("a variance").into_iter().zip(ERRORS) {
            near(time, variance / (error * truth).powi(2) * seconds);
        }
        assert!(times.speedup.least <= times.speedup.median);
        assert!(times.speedup.median <= times.speedup.most);
        let last = row.curve.last().expect("a curve");
        assert_eq!((row.draws, last.draws), (Some(30_000), 10_000));
        near(last.predicted.expect("a variance"), (variance / 1e4).sqrt() / truth);
        near(times.seconds(last.draws), 1e4 * seconds);
        // Six deviations of the root mean square of three rounds.
        assert!(last.relative < 6.0 * last.predicted.expect("a variance"), "{last:?}");
    }
    assert_eq!(rows(&found).filter(|row| row.fom.is_some()).count(), 3);
}

#[test]
fn what_has_no_error_to_wait_for_says_so() {
    let found = bench(&[case("case", CASE), case("bias", BIASED)], 1);
    let row = |name: &str| rows(&found).find(|row| row.id.estimator.name == name).expect("a row");
    let (regular, marching, refused) = (row("regular"), row("ray-marching"), row("woodcock"));
    for row in [regular, marching] {
        let times = row.times.as_ref().expect("it was timed");
        assert_eq!((times.seconds_to, times.efficiency, row.fom), (None, None, None));
    }
    assert!(regular.reason.contains("no variance") && regular.curve.is_empty());
    assert!(marching.reason.contains("biased") && !marching.curve.is_empty());
    assert!(refused.is_refused && refused.times.is_none() && refused.reason.contains("σ_t"));
}

/// Returns a bench without the numbers that depend on the machine.
fn results(mut bench: Bench) -> String {
    for row in bench.cases.iter_mut().flat_map(|case| &mut case.rows) {
        row.times = None;
    }
    serde_json::to_string(&bench.cases).expect("is JSON")
}

#[test]
fn all_but_the_times_is_the_same_on_any_number_of_threads() {
    let cases = [case("case", CASE), case("curve", CURVE)];
    let (one, again, three) = (bench(&cases, 1), bench(&cases, 1), bench(&cases, 3));
    assert!(rows(&three).all(|row| row.times.as_ref().is_none_or(|t| t.scaling.is_some())));
    assert!(rows(&one).all(|row| row.times.as_ref().is_none_or(|t| t.scaling.is_none())));
    let one = results(one);
    assert_eq!(one, results(again));
    assert_eq!(one, results(three));
}

#[test]
fn a_bench_writes_its_files_and_prints_its_table() {
    let place = Place::new(&[("case.toml", CASE)]);
    let output = place.run("bench case.toml --draws 2000 --rounds 2 --out here");
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(output.stderr.is_empty(), "without a terminal there is no progress");
    for words in ["ns/draw", "speedup", "to 1e-3", "4 timed · 1 refused", "2 rounds of 2000 draws"]
    {
        assert!(text.contains(words), "no \"{words}\" in:\n{text}");
    }
    let mut names: Vec<String> = std::fs::read_dir(place.path().join("here"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(names, ["bench.csv", "case.error.csv", "case.png", "case.svg", "report.html"]);
}

#[test]
fn the_same_columns_go_everywhere() {
    let place = Place::new(&[("case.toml", CASE)]);
    let csv = stdout(&place.run("bench case.toml --draws 1000 --rounds 1 --out here --format csv"));
    let file = std::fs::read_to_string(place.path().join("here/bench.csv")).expect("a file");
    assert_eq!(csv, file);
    assert_eq!(csv.lines().count(), 6);
    let json = place.run("bench case.toml --draws 1000 --rounds 1 --out here --format json");
    let rows: Vec<serde_json::Map<String, serde_json::Value>> =
        serde_json::from_slice(&json.stdout).expect("JSON and nothing else");
    assert_eq!(rows.len(), 5);
    for column in csv.lines().next().expect("names").split(',') {
        assert!(rows[0].contains_key(column), "no {column}");
    }
}

/// Other vector hardware changes draws only without fused multiply-add; the table names the hardware.
#[test]
fn the_level_of_vector_hardware_can_be_chosen() {
    let place = Place::new(&[("case.toml", CASE)]);
    for level in pack::levels().into_iter().map(pack::word) {
        let bench = format!("bench case.toml --draws 1000 --rounds 1 --out here --level {level}");
        let output = place.run(&bench);
        let text = stdout(&output);
        assert!(output.status.success() && text.contains(&level), "{level} in {text}");
    }
    let unknown = place.run("bench case.toml --level abacus");
    let error = String::from_utf8_lossy(&unknown.stderr);
    assert!(error.contains("this machine has"), "{error}");
}

#[test]
fn usage_is_2_and_nothing_is_written() {
    let place = Place::new(&[("case.toml", CASE)]);
    for arguments in [
        "bench nowhere.toml",
        "bench case.toml --draws 0",
        "bench case.toml --draws -5",
        "bench case.toml --rounds 0",
        "bench case.toml --threads 0",
        "bench case.toml --level abacus",
        "bench case.toml --filter [",
        "bench case.toml --filter nothing-of-the-kind",
        "bench case.toml --format yaml",
        "bench case.toml --baseline none --draws 1000000000",
        "bench case.toml --baseline a/b",
        "bench case.toml --save-baseline a/b",
        "bench case.toml --out case.toml/below --draws 1000000000",
        "bench case.toml --time-tolerance -1",
    ] {
        let output = place.run(&format!("{arguments} --quiet"));
        assert_eq!(output.status.code(), Some(2), "trueflight {arguments}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty(), "trueflight {arguments}");
    }
    let refused =
        CASE.replace(", { ratio = {} }, { regular = {} }", "").replace("[0.5, 1]", "[0.5]");
    std::fs::write(place.path().join("refused.toml"), refused).expect("a case file");
    let output = place.run("bench refused.toml");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("refused"));
    assert!(!place.path().join("results/bench/bench.csv").exists());
}

#[test]
fn a_stored_bench_is_compared_with() {
    let place = Place::new(&[("case.toml", CASE)]);
    let bench = "bench case.toml --draws 1000 --rounds 2 --out here --quiet";
    assert_eq!(code(&place.run(&format!("{bench} --save-baseline main"))), 0);
    let path = place.path().join("baselines/main.bench.json");
    let text = std::fs::read_to_string(&path).expect("a baseline");
    assert_eq!(code(&place.run(&format!("{bench} --baseline main --time-tolerance inf"))), 0);
    // Times as if everything had been a million times as fast.
    let mut tree: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for timed in tree["timed"].as_array_mut().expect("experiments") {
        for figure in ["median", "least", "most"] {
            let time = timed["ns_per_draw"][figure].as_f64().expect("a time");
            timed["ns_per_draw"][figure] = (time * 1e-6).into();
        }
    }
    std::fs::write(&path, tree.to_string()).expect("a baseline");
    assert_eq!(code(&place.run(&format!("{bench} --baseline main"))), 1);
    let output = place.run(&format!("{bench} --baseline main --threads 2"));
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--threads 1"));
    // A bench of other experiments is not comparable.
    let tree = text.replace("\"problem\": \"", "\"problem\": \"other ");
    std::fs::write(&path, tree).expect("a baseline");
    let output = place.run(&format!("{bench} --baseline main"));
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("main.bench.json: nothing was compared"), "{said}");
    std::fs::write(&path, "{\"schema\": 9}").expect("a baseline");
    assert_eq!(code(&place.run(&format!("{bench} --baseline main"))), 2);
}

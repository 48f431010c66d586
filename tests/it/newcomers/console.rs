//! The console of a run: rows that do not pass, the path of the page, progress.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common;
use crate::common::place::Place;
use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::draw::run;
use trueflight::draw::run::Step;
use trueflight::draw::store::{Header, Store};
use trueflight::plan::Plan;

const GOOD: &str = "title = \"a good case\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sampling.constant.value = 1
estimators = [{ woodcock = {} }, { ratio = {} }]
";

/// Returns a case with a bias: ray marching with two steps through a kink, with a random offset and without.
fn biased() -> String {
    let linear = "medium.piecewise-linear = { knots = [0, 0.5, 2], values = [0.1, 1.0, 0.1] }";
    GOOD.replace("{ woodcock = {} }", "{ ray-marching = { steps = 2, jitter = true } }")
        .replace("medium.constant.extinction = 0.5", linear)
}

#[test]
fn a_run_shows_what_does_not_pass_and_ends_with_its_page() {
    let place = Place::new(&[("good.toml", GOOD), ("bad.toml", &biased())]);
    let said = place.says(0, "run good.toml --draws 400000 --out here");
    let first = "good: 2 experiments, 400000 draws each planned and at most 888889, seed 1, α = 0.001\ngood  2 pass · ";
    assert!(said.starts_with(first), "{said}");
    let meaning =
        "pass: nothing of 2 fails or is inconclusive\nEvery mean that passes is right to ";
    assert!(said.contains(meaning), "{said}");
    assert!(!said.contains("woodcock"), "{said}");
    let page = place.path().join("here/report.html");
    assert!(page.exists());
    assert_eq!(said.lines().last(), Some("report: here/report.html"));
    let said = place.says(1, "run bad.toml --draws 400000 --out there");
    assert!(
        said.contains("ray-marching")
            && said.contains("bad  1 pass, 1 fail · ")
            && said.contains("fail: 1 of 2 fail\n"),
        "{said}"
    );
    assert!(!said.lines().any(|line| line.starts_with("ratio")), "{said}");
    assert_eq!(said.lines().last(), Some("report: there/report.html"));
}

#[test]
fn verbose_shows_every_row_and_quiet_none() {
    let place = Place::new(&[("good.toml", GOOD)]);
    for flag in ["-v", "--verbose"] {
        for command in ["run", "check"] {
            let said = place.says(0, &format!("{command} good.toml --draws 400000 {flag}"));
            assert!(said.contains("woodcock") && said.contains("ratio"), "{command}: {said}");
        }
    }
    assert_eq!(place.says(0, "run good.toml --draws 400000 --quiet"), "");
    assert_eq!(place.says(0, "check good.toml --draws 400000 --quiet --out out"), "");
    let csv = place.says(0, "run good.toml --draws 400000 --format csv");
    assert!(csv.starts_with("case,problem") && csv.lines().count() == 3, "{csv}");
    let said = place.says(0, "check good.toml --draws 400000 --out out");
    assert_eq!(said.lines().last(), Some("report: out/report.html"));
}

#[test]
fn a_log_has_no_codes_of_a_terminal() {
    let place = Place::new(&[("bad.toml", &biased())]);
    for command in ["plan bad.toml", "run bad.toml --draws 400000 -v", "check bad.toml"] {
        let output = place.run(command);
        for text in [&output.stdout, &output.stderr] {
            assert!(!text.contains(&0x1b) && !text.contains(&b'\r'), "{command}");
        }
        assert!(output.stderr.is_empty(), "{command}: no progress without a terminal");
    }
}

#[test]
fn a_failure_is_told_in_one_unit_with_its_likely_causes() {
    let place = Place::new(&[("bad.toml", &biased())]);
    let said =
        place.says(1, "check bad.toml --draws 400000 --junit j.xml --markdown s.md --out out");
    let told = |text: &str| {
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        // A column may cut the first one short.
        let after = text.rsplit("the mean is off by ").next().expect("a failure").to_owned();
        let after = after.replace("\\_", "_");
        let (percent, rest) = after.split_once(" % (measured ").expect("a percentage");
        let (measured, rest) = rest.split_once(", expected ").expect("a measured value");
        let (expected, rest) = rest.split_once("), z = ").expect("an expected value");
        let (z, rest) = rest.split_once(" over ").expect("a z-score");
        assert!(rest.contains(" draws"), "{rest}");
        let numbers = [percent, measured, expected, z];
        numbers.map(|text| text.parse::<f64>().expect("a number"))
    };
    let [percent, measured, expected, z] = told(&said);
    // The exact answer is exp(−(0.275 + 0.825)).
    assert!((expected - (-1.1_f64).exp()).abs() < 1e-4, "{expected}");
    assert!((percent - 100.0 * (measured / expected - 1.0)).abs() < 0.06 * percent.abs());
    assert!(z * percent > 0.0 && z.abs() > 5.0, "{z}");
    let read = |file: &str| std::fs::read_to_string(place.path().join(file)).expect("a report");
    for text in [said.clone(), read("j.xml"), read("s.md"), read("out/report.html")] {
        assert_eq!(told(&text), [percent, measured, expected, z]);
        assert!(text.contains("usual causes where") && text.contains("docs/failures.md"), "{text}");
    }
}

fn built_in(names: &[&str]) -> Vec<Case> {
    let sources = suite::suite().into_iter().filter(|source| names.contains(&source.name.as_str()));
    sources.map(|source| Case::read(&source).expect("a case")).collect()
}

/// Returns the steps of a drawing, made and kept draws summed up: expected first and last, made, kept.
fn steps(plan: &Plan, store: &Store) -> [u64; 4] {
    let steps = Mutex::new(Vec::new());
    let draws = run::draw_with(plan, store, &|step| {
        steps.lock().expect("it").push(step);
    });
    let steps = steps.into_inner().expect("it");
    let expected: Vec<u64> = steps
        .iter()
        .filter_map(|step| if let Step::Expected(draws) = step { Some(*draws) } else { None })
        .collect();
    let sum = |wanted: fn(&Step) -> Option<u64>| steps.iter().filter_map(wanted).sum();
    let made = sum(|step| if let Step::Drawn(draws) = step { Some(*draws) } else { None });
    let kept = sum(|step| if let Step::Kept(draws) = step { Some(*draws) } else { None });
    assert!(!draws.cut_by_time);
    [expected[0], *expected.last().expect("a last"), made, kept]
}

#[test]
fn the_total_counts_what_will_be_drawn() {
    let cases =
        built_in(&["transmittance/eq21-overview", "transmittance/known-bugs", "rod/known-bugs"]);
    assert_eq!(cases.len(), 3);
    let options = common::options(1, 400_000);
    let plan = Plan::new(&cases, &options);
    let [first, last, made, kept] = steps(&plan, &Store::default());
    assert_eq!((last, kept), (made, 0), "at its end the total is what was drawn");
    let share = first as f64 / made as f64;
    assert!((0.7..1.3).contains(&share), "{first} were expected, {made} were drawn");
    // The number of planned draws would be too many.
    let planned: u64 = plan.experiments().filter(|e| e.1.outcome.is_ok()).map(|e| e.1.draws).sum();
    assert!(planned > made + made / 10, "{planned} planned, {made} drawn");
    assert!(first.abs_diff(made) < planned - made, "{first} expected, {made} drawn");
}

#[test]
fn what_an_earlier_run_drew_is_no_part_of_the_total() {
    let cases = built_in(&["transmittance/eq21-overview"]);
    let options = common::options(1, 100_000);
    let plan = Plan::new(&cases, &options);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("draws.bin");
    let mut store = Store::new(Header::new(&plan, "this program", &[], None));
    store.finish(&path, &run::draw(&plan, &|_| {})).expect("written");
    store.reuse(&path, false).expect("it can be read");
    let [first, last, made, _] = steps(&plan, &store);
    let fresh = steps(&plan, &Store::default());
    assert_eq!(last, made);
    // Experiments without moments are always drawn.
    assert!(first <= fresh[0] / 4, "{first} of {}", fresh[0]);
}

#[test]
fn planning_tells_how_many_experiments_are_prepared() {
    let cases = built_in(&["transmittance/eq21-overview", "rod/known-bugs"]);
    let (most, all) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let plan = Plan::with_progress(&cases, &common::options(1, 1000), &|prepared, of| {
        most.fetch_max(prepared, Ordering::Relaxed);
        all.store(of, Ordering::Relaxed);
    });
    let experiments = plan.experiments().count();
    assert_eq!((most.into_inner(), all.into_inner()), (experiments, experiments));
}

#[test]
fn numbers_of_options_say_what_they_count() {
    let place = Place::new(&[("good.toml", GOOD)]);
    for (option, cures) in [
        ("check --budget 5", ["5s", "16384"]),
        ("check --budget 60", ["60m", "block"]),
        ("check --budget 0.5", ["0.5h", "block"]),
        ("check --budget 16383", ["16383s", "16384"]),
        ("check --budget 0", ["30s", "1e8"]),
        ("check --budget -1", ["30s", "1e8"]),
        ("check --budget nan", ["30s", "1e8"]),
        ("check --budget 1e308", ["30s", "1e8"]),
        ("check --budget 1e308h", ["30s", "1e8"]),
        ("run --budget 5", ["5s", "16384"]),
        ("run --budget 5d", ["30s", "1e8"]),
        ("run --draws 1", ["from 2", "4e6"]),
        ("run --draws -1", ["from 2", "4e6"]),
        ("run --draws 2.5", ["whole number", "4e6"]),
        ("run --draws nan", ["whole number", "4e6"]),
        ("run --draws 1e308", ["1e12", "4e6"]),
        ("plan --draws 0", ["from 2", "4e6"]),
    ] {
        let output = place.run(&format!("{option} good.toml"));
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{option}: {error}");
        assert!(output.stdout.is_empty(), "{option}");
        assert!(cures.iter().all(|cure| error.contains(cure)), "{option}: {error}");
        assert!(!place.path().join("results").exists(), "{option} wrote something");
    }
    place.says(0, "check good.toml --budget 20s");
    place.says(0, "check good.toml --budget 1e8");
}

//! `trueflight check`: exit codes, reports for every verdict, and the output for GitHub.

use std::path::Path;
use std::process::Output;

use crate::common::place::{Place, assert_says, code, said};

/// Text of a case that passes within the default draws.
const GOOD: &str = "title = \"a good case\"
[problem.transmittance]
medium.piecewise-linear = { knots = [0, 0.5, 2], values = [0.1, 1.0, 0.1] }
span = [0, 2]
sampling.constant.value = 1.1
estimators = [{ woodcock = {} }, { ratio = {} }]
";

/// Returns that case with a biased estimator that is not declared biased.
fn biased() -> String {
    GOOD.replace("{ woodcock = {} }", "{ ray-marching = { steps = 2 } }")
}

const FILES: &str = "--junit junit.xml --record record.json --markdown summary.md";

/// Returns a folder with one case.
fn place_of(text: &str) -> Place {
    Place::new(&[("cases/case.toml", text)])
}

/// Runs `check`, and compares the exit code.
fn check(place: &Place, expected: i32, arguments: &str) -> Output {
    let output = place.run(&format!("check {arguments}"));
    assert_eq!(code(&output), expected, "{arguments}: {}", said(&output));
    output
}

/// Returns all reports; checks that they exist, are complete, and have no colours.
fn reports(place: &Place) -> [String; 3] {
    let [junit, json, markdown] =
        ["junit.xml", "record.json", "summary.md"].map(|name| place.read(name));
    assert!(junit.trim_end().ends_with("</testsuites>"), "{junit}");
    let record: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(record["schema"], trueflight::record::SCHEMA);
    assert!(json.starts_with("{\"schema\":"));
    assert!(markdown.starts_with("## Trueflight"), "{markdown}");
    for text in [&junit, &json, &markdown] {
        assert!(!text.contains('\u{1b}'), "colours in a file");
    }
    [junit, json, markdown]
}

#[test]
fn all_pass_is_0_and_quiet_about_it() {
    let place = place_of(GOOD);
    let output = check(&place, 0, &format!("cases {FILES} --color always"));
    let text = said(&output);
    assert_says(&text, &["case  2 pass · ", " draws", "visible bias", "share α = 0.001", "seed 1"]);
    assert!(!text.contains("woodcock"), "a row that passes is shown:\n{text}");
    reports(&place);
    assert!(!place.path().join("results").exists());
    assert_says(&said(&check(&place, 0, "cases --verbose")), &["woodcock", "ratio"]);
    assert_eq!(said(&check(&place, 0, "cases --quiet")), "");
}

#[test]
fn a_failure_is_1_and_its_reports_are_written() {
    let place = place_of(&biased());
    let output = check(&place, 1, &format!("cases {FILES} --out out --seed 3 --color always"));
    let [junit, _, markdown] = reports(&place);
    let words = ["ray-marching", "off by", "--seed 3 --draws 8", "trueflight check cases/case"];
    for text in [said(&output), junit, markdown] {
        assert_says(&text, &words);
    }
    assert_says(&said(&output), &["seed 3, block 0", "repeat: "]);
    assert!(place.read("out/summary.csv").contains(",fail,"));
    assert!(place.read("out/record.json").starts_with("{\"schema\":"));
    assert!(place.read("out/report.html").contains("<h1>fail: "));
    assert_eq!(std::fs::read_dir(place.path().join("out")).expect("a folder").count(), 3);
}

#[test]
fn what_repeats_a_failure_repeats_it() {
    let place = place_of(&biased());
    let text = said(&check(&place, 1, "cases"));
    let line = text.lines().find_map(|line| line.trim().strip_prefix("repeat: trueflight "));
    let words = line.expect("a command").split('\'');
    let mut command = place.command("");
    for (i, word) in words.enumerate() {
        // Every second piece is quoted.
        if i % 2 == 1 {
            command.arg(word)
        } else {
            command.args(word.split_whitespace())
        };
    }
    let output = command.output().expect("it runs");
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert_says(&said(&output), &["ray-marching", "off by"]);
}

#[test]
fn inconclusive_is_3_unless_one_says_otherwise() {
    let place = place_of(GOOD);
    for (code, flag, in_junit) in [
        (3, "", "<error "),
        (1, "--inconclusive fail", "<failure "),
        (0, "--inconclusive pass", "<skipped "),
    ] {
        let output = check(&place, code, &format!("cases --draws 1000 {FILES} {flag}"));
        let [junit, _, markdown] = reports(&place);
        assert_says(&junit, &[in_junit, "type=\"inconclusive\"", "draws"]);
        assert_says(&markdown, &["### Inconclusive", "To decide"]);
        assert_says(&said(&output), &["2 inconclusive"]);
        let run = place.command(&format!("run cases --draws 1000 {flag}")).output().expect("runs");
        assert_eq!(run.status.code(), Some(code), "run {flag}");
    }
    assert!(place.read("results/record.json").starts_with("{\"schema\":"));
    // `--inconclusive` does not change a failure.
    check(&place_of(&biased()), 1, "cases --inconclusive pass");
}

#[test]
fn a_budget_of_draws_is_kept() {
    let place = place_of(GOOD);
    let output = check(&place, 0, &format!("cases --budget 100000 {FILES}"));
    assert_says(&said(&output), &["2 pass"]);
    let record: serde_json::Value = serde_json::from_str(&place.read("record.json")).expect("JSON");
    let all = record["results"]["cases"][0]["experiments"].as_array().expect("a list").clone();
    let drawn: u64 = all.iter().filter_map(|one| one["drawn"].as_u64()).sum();
    assert!(drawn > 60_000 && drawn <= 100_000, "{drawn} draws");
    check(&place, 0, "cases --budget 5m");
}

#[test]
fn usage_is_2_before_anything_is_drawn() {
    let place = place_of(GOOD);
    std::fs::write(place.path().join("file"), "").expect("a file");
    std::fs::create_dir(place.path().join("empty")).expect("a folder");
    for (arguments, words) in [
        ("cases --filter nothing-of-the-kind", ["--filter", "trueflight plan"]),
        ("empty", ["empty", "no case file"]),
        ("cases --budget soon", ["--budget", "30s"]),
        ("cases --budget 0", ["--budget", "1e8"]),
        ("cases --inconclusive maybe", ["--inconclusive", "fail"]),
        ("cases --no-such-flag", ["--no-such-flag", "Usage"]),
        ("cases --junit nowhere/a.xml", ["--junit", "nowhere"]),
        ("cases --record file/a.json", ["--record", "file"]),
        ("cases --markdown cases", ["--markdown", "directory"]),
        ("cases --junit same --record same", ["--record", "another report"]),
        ("cases --record cases/case.toml", ["--record", "a case"]),
        ("cases --out file", ["--out", "file"]),
    ] {
        let begin = std::time::Instant::now();
        let output = check(&place, 2, &format!("{arguments} --draws 1000000000"));
        assert!(output.stdout.is_empty(), "{arguments}: {}", said(&output));
        assert_says(&said(&output), &words);
        assert!(begin.elapsed().as_secs() < 20, "it drew first");
    }
}

#[test]
fn github_gets_annotations_and_a_summary() {
    let place = place_of(&biased());
    let summary = place.path().join("summary.md");
    std::fs::write(&summary, "before\n").expect("a file");
    let on_github = |summary: &Path| {
        let mut command = place.command("check cases");
        command.env("GITHUB_ACTIONS", "true").env("GITHUB_STEP_SUMMARY", summary);
        command.output().expect("it runs")
    };
    let output = on_github(&summary);
    assert_eq!(output.status.code(), Some(1));
    let text = said(&output);
    let error = text.lines().find(|line| line.starts_with("::error ")).expect("an annotation");
    assert_says(error, &["title=fail case%3A ray-marching", "file=cases/case.toml", "%0Arepeat: "]);
    let written = place.read("summary.md");
    assert!(written.starts_with("before\n## Trueflight"), "{written}");
    // A summary that cannot be written does not change the verdict.
    let output = on_github(&place.path().join("no/summary.md"));
    assert_eq!(output.status.code(), Some(1));
    assert_says(&said(&output), &["warning: ", "no/summary.md", "::error "]);
    // Elsewhere neither is written.
    assert!(!said(&check(&place, 1, "cases")).contains("::error"));
}

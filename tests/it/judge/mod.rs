//! `trueflight judge`: the gate over draws from a file or a pipe.

mod channels;
mod distributions;
mod field;
mod grounds;
mod image_files;
mod images;
mod mistakes;
mod noisy;
mod order;
mod swept;

use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use gate::stats::verdict::BLOCK;
use tempfile::TempDir;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::draw::run;
use trueflight::estimators::DrawBuffer;
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::record::{Finding, build};
use trueflight::stats::gate::{Decision, Design, GateSums, tolerance_of};

const CASE: &str = "title = \"a case\"
[problem.transmittance]
medium.constant.extinction = 0.5
span = [0, 2]
sweep.sampling.values = [0.8, 1.0]
estimators = [{ ratio = {} }, { ratio = { sampling.constant.value = 2.0 } }, { woodcock = {} }]
";

/// Returns uniform draws about 1 of variance 1/48 and kurtosis 1.8, by a linear congruence.
fn uniform(n: usize) -> Vec<f64> {
    let mut state = 7u64;
    let next = |state: &mut u64| {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        0.75 + 0.5 * (*state >> 11) as f64 / 9_007_199_254_740_992.0
    };
    (0..n).map(|_| next(&mut state)).collect()
}

const UNIFORM: &str = "--truth 1 --variance 0.020833333333333332 --kurtosis 1.8";

fn raw(draws: &[f64]) -> Vec<u8> {
    draws.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn npy(kind: &str, shape: &str, bytes: &[u8]) -> Vec<u8> {
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    let padding = 63 - (10 + header.len()) % 64;
    header += &(" ".repeat(padding) + "\n");
    let length = u16::try_from(header.len()).expect("short").to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], header.as_bytes(), bytes].concat()
}

fn csv(draws: &[f64]) -> Vec<u8> {
    let lines = draws.iter().enumerate().map(|(i, x)| format!("{i},{x:?}\n"));
    (String::from("id,X\n") + &lines.collect::<String>()).into_bytes()
}

struct Place(TempDir);

impl Place {
    fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = TempDir::new().expect("a folder");
        for (name, bytes) in files {
            std::fs::write(folder.path().join(name), bytes).expect("a file");
        }
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn judge(&self, arguments: &str, pipe: &[u8]) -> Output {
        let mut command = Command::cargo_bin("trueflight").expect("the binary");
        command.current_dir(self.path()).env("COLUMNS", "400").arg("judge");
        command.args(arguments.split_whitespace()).write_stdin(pipe).output().expect("it runs")
    }

    /// Returns the exit code and the output.
    fn says(&self, arguments: &str, pipe: &[u8]) -> (i32, String) {
        let output = self.judge(arguments, pipe);
        let text = [output.stdout, output.stderr].concat();
        (output.status.code().expect("a code"), String::from_utf8(text).expect("text"))
    }

    fn json(&self, arguments: &str, pipe: &[u8]) -> serde_json::Value {
        let output = self.judge(&format!("{arguments} --format json"), pipe);
        serde_json::from_slice(&output.stdout).expect("JSON and nothing else")
    }

    fn expect(&self, code: i32, arguments: &str, words: &[&str]) {
        let (found, text) = self.says(arguments, &[]);
        assert_eq!(found, code, "{arguments}: {text}");
        for word in words {
            assert!(text.contains(word), "no \"{word}\" from {arguments}:\n{text}");
        }
        if code == 2 {
            assert_eq!(text.matches("error:").count(), 1, "{arguments}:\n{text}");
        }
    }
}

#[test]
fn every_format_and_the_pipe_get_the_same_verdict() {
    let draws = uniform(200_000);
    let place = Place::new(&[
        ("x.f64", &raw(&draws)),
        ("x.npy", &npy("<f8", "(200000,)", &raw(&draws))),
        ("x.csv", &csv(&draws)),
    ]);
    let expected = place.json(&format!("{UNIFORM} x.f64"), &[]);
    assert_eq!(expected["verdict"], "pass");
    for file in ["x.npy", "--column X x.csv", "--column 1 x.csv"] {
        assert_eq!(place.json(&format!("{UNIFORM} {file}"), &[]), expected, "{file}");
    }
    let wrong = UNIFORM.replace("truth 1", "truth 1.01");
    for (input, bytes) in [
        ("f64", raw(&draws)),
        ("npy", npy("<f8", "(200000,)", &raw(&draws))),
        ("csv --column X", csv(&draws)),
    ] {
        let (code, text) = place.says(&format!("{UNIFORM} --input {input} -"), &bytes);
        assert_eq!(code, 0, "{input}: {text}");
        let (code, text) = place.says(&format!("{wrong} --input {input} -"), &bytes);
        assert_eq!(code, 1, "{input}: {text}");
    }
    for file in ["x.f64", "x.npy", "--column X x.csv"] {
        place.expect(1, &format!("{wrong} {file}"), &["fail", "the mean is off by"]);
        let narrow = format!("{UNIFORM} --tolerance 1e-6 {file}");
        place.expect(3, &narrow, &["inconclusive", "needs 5.6e11"]);
    }
}

#[test]
fn the_verdict_is_that_of_the_gate() {
    let draws = uniform(300_000);
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    for truth in [1.0, 1.002, 1.003, 1.01] {
        let v = 1.0 / 48.0 / (truth * truth);
        let design = Design::new(v, tolerance_of(v, 300_000.0), 4e-13);
        let (mut sums, mut blocks, mut look) = (GateSums::default(), 0u64, 1);
        let mut decided = (Decision::Open, 0);
        for block in draws.chunks(1 << 14) {
            let y: Vec<f64> = block.iter().map(|x| (x - truth) / truth).collect();
            sums.absorb(&y, &design.arguments());
            blocks += 1;
            let seen = (blocks * BLOCK).min(300_000);
            if blocks == look || seen == 300_000 {
                let evidence = design.evidence(sums.totals(), seen as f64);
                // Mean and variance share four fifths of α = 1e-3; the drift has the rest.
                let decision = evidence.decision(2500f64.ln(), 100f64.ln());
                if decision != Decision::Open {
                    decided = (decision, seen);
                    break;
                }
                look = (look + 1).max(look * 115 / 100);
            }
        }
        let variance = 1.0 / 48.0 + (truth - 1.0) * (truth - 1.0);
        let arguments = format!("--truth {truth} --variance {} --kurtosis 1.8 x.f64", 1.0 / 48.0);
        assert!(variance < 1.1 / 48.0);
        let found = place.json(&arguments, &[]);
        let mean = &found["findings"][0];
        let word = match decided.0 {
            Decision::Passed => "pass",
            Decision::Failed => "fail",
            Decision::Open => "inconclusive",
        };
        assert_eq!(mean["verdict"], word, "{truth}");
        if decided.0 != Decision::Open {
            assert_eq!(mean["gate"]["draws"], decided.1, "{truth}");
        }
    }
}

#[test]
fn the_variance_is_tested_and_can_be_done_without() {
    let draws = uniform(200_000);
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    place.expect(1, "--truth 1 --variance 0.025 --kurtosis 1.8 x.f64", &["the variance is off"]);
    // A variance that is too small may be refuted by squares alone. One that is too large may rest on squares that were
    // not drawn, unless a range excludes them.
    place.expect(1, "--truth 1 --variance 0.0173 x.f64", &["the variance is off"]);
    let large = "--truth 1 --variance 0.025";
    place.expect(3, &format!("{large} x.f64"), &["looks off", "the kurtosis or the range"]);
    place.expect(1, &format!("{large} --range 0.75,1.25 x.f64"), &["the variance is off"]);
    let known = format!("--truth 1 --variance {} x.f64", 1.0 / 48.0);
    place.expect(0, &known, &["kurtosis estimated"]);
    place.expect(0, "--truth 1 x.f64", &["variance estimated", "not tested"]);
    place.expect(3, "--truth 1.01 x.f64", &["variance estimated", "the mean looks off by -0.9"]);
    let tails = format!("--truth 1 --variance {} --kurtosis 1e7 x.f64", 1.0 / 48.0);
    place.expect(0, &tails, &["variance assumed", "underpowered"]);
}

#[test]
fn an_estimated_variance_waits_for_rare_events() {
    let mut rare = vec![0.0; 100_000];
    rare[5] = 1e4;
    rare[80_000] = 1e4;
    let place = Place::new(&[("x.f64", &raw(&rare)), ("short.f64", &raw(&uniform(10_000)))]);
    let missing = ["is not known", "the variance, the range or the largest kurtosis"];
    place.expect(3, "--truth 0.2 x.f64", &missing);
    place.expect(3, "--truth 1 short.f64", &missing);
    place.expect(0, "--truth 1 --kurtosis 1.8 short.f64", &["a kurtosis of 1.8 at most"]);
    place.expect(3, "--truth 1 --kurtosis 180 short.f64", &["others after it; there are 10000"]);
}

#[test]
fn what_is_not_a_finite_number_fails_with_its_place() {
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut draws = uniform(50_000);
        draws[20_003] = value;
        let place = Place::new(&[("x.f64", &raw(&draws)), ("x.csv", &csv(&draws))]);
        for file in ["x.f64", "--column X x.csv"] {
            place.expect(1, &format!("{UNIFORM} {file}"), &["numeric", "draw 20003"]);
        }
        place.expect(1, "--truth 1 x.f64", &["numeric", "draw 20003"]);
    }
}

#[test]
fn draws_without_spread_are_the_truth() {
    let mut draws = vec![0.25 * (1.0 + 1e-14); 40_000];
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    place.expect(0, "--truth 0.25 --variance 0 x.f64", &["pass", "no spread"]);
    place.expect(1, "--truth 0.25 --variance 0 --rounding 1e-15 x.f64", &["draw 0 is"]);
    draws[30_000] = 0.2501;
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    place.expect(1, "--truth 0.25 --variance 0 x.f64", &["draw 30000 is", "rounding"]);
}

#[test]
fn a_spread_near_rounding_goes_through_the_gate() {
    let tight: Vec<f64> = uniform(100_000).iter().map(|x| 1.0 + 1e-10 * (x - 1.0)).collect();
    let off: Vec<f64> = tight.iter().map(|x| x + 1e-10).collect();
    let place = Place::new(&[("tight.f64", &raw(&tight)), ("off.f64", &raw(&off))]);
    let claim = "--truth 1 --variance 2.0833333333333333e-22 --kurtosis 1.8";
    place.expect(0, &format!("{claim} tight.f64"), &[]);
    place.expect(1, &format!("{claim} off.f64"), &[]);
    // Rounding above the widest tolerance is a mistake in the arguments.
    place.expect(2, "--truth 1 --variance 1 --rounding 0.02 tight.f64", &[]);
    place.expect(2, "--truth 1 --variance-tolerance 0.1 tight.f64", &[]);
    // Wrong draws without any spread.
    std::fs::write(place.0.path().join("wrong.f64"), raw(&vec![0.9; 100_000])).expect("a file");
    let wrong = "wrong.f64";
    place.expect(1, &format!("--truth 1 --range 0,2 {wrong}"), &["the mean is off"]);
    // Without a range each may also be the constant part of a distribution with rare large values.
    place.expect(3, &format!("--truth 1 {wrong}"), &["is not known: 0 of 100000 draws"]);
    place.expect(1, &format!("--truth 1e-300 {wrong}"), &["beyond measure"]);
}

#[test]
fn a_truth_of_0_takes_an_absolute_tolerance() {
    let draws: Vec<f64> = uniform(200_000).iter().map(|x| x - 1.0).collect();
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    let zero = UNIFORM.replace("truth 1", "truth 0");
    place.expect(2, &format!("{zero} x.f64"), &["truth of 0", "absolute"]);
    place.expect(0, &format!("{zero} --tolerance 2e-3 x.f64"), &["pass"]);
}

#[test]
fn bad_input_is_2_with_one_clear_error() {
    let draws = raw(&uniform(100));
    let place = Place::new(&[
        ("part.f64", &draws[..77]),
        ("short.npy", &npy("<f8", "(200,)", &draws)),
        ("int.npy", &npy("<i8", "(100,)", &draws)),
        ("two.npy", &npy("<f8", "(10, 10)", &draws)),
        ("none.npy", b"no array"),
        ("empty.f64", b""),
        ("names.csv", b"nan\n"),
        ("header.csv", b"X\n"),
        ("two.csv", b"A,B\n1,2\n"),
        ("word.csv", b"X\n1\nx\n"),
        ("x.dat", &draws),
        ("x.f64", &draws),
        ("case.toml", CASE.as_bytes()),
    ]);
    for (arguments, word) in [
        ("--truth 1 part.f64", "5 bytes more than"),
        ("--truth 1 short.npy", "100 of 200"),
        ("--truth 1 int.npy", "type <i8"),
        ("--truth 1 two.npy", "shape (10, 10)"),
        ("--truth 1 none.npy", "not an npy file"),
        ("--truth 1 empty.f64", "no draws"),
        ("--truth 1 header.csv", "no draws"),
        ("--truth 1 two.csv", "choose one"),
        ("--truth 1 --column C two.csv", "no column `C`"),
        ("--truth 1 word.csv", "`x` is not a number"),
        ("--truth 1 x.dat", "--input"),
        ("--truth 1 -", "--input"),
        ("--truth 1 nowhere.f64", "nowhere.f64"),
        ("--truth 1 --column X x.f64", "--column"),
        ("--truth nan x.f64", "truth"),
        ("--truth 1 --variance -1 x.f64", "variance"),
        ("--truth 1 --range 2,3 x.f64", "does not have the truth 1 inside"),
        ("--truth 1 --range 3,2 x.f64", "give LOW,HIGH"),
        ("--truth 1 --range nan,2 x.f64", "give LOW,HIGH"),
        ("--truth 0.5 --range 0,1 --variance 0.3 x.f64", "impossible in the range"),
        ("--truth 1 --batch 0 x.f64", "--batch"),
        ("--truth 1 --draws 0 x.f64", "--draws"),
        ("--truth 1 --lookups X x.f64", "--expected-lookups"),
        ("--truth 1 --lookups X --expected-lookups 3 x.f64", "only csv"),
        ("--truth 1 --lookups X --expected-lookups -3 x.f64", "expected lookups"),
        ("--truth 1 --junit nowhere/report.xml x.f64", "--junit"),
        ("--truth 1 --junit x.f64 x.f64", "it holds draws"),
        ("--truth 1 - - --input f64", "one pipe"),
        ("--truth 1 x.f64 nowhere.f64", "nowhere.f64"),
        ("--case case.toml --estimator woodcock --swept 1 --variance 1 x.f64", "--mean-only"),
        ("--truth 1 --variance 1 --kurtosis 0.5 x.f64", "kurtosis"),
        ("--truth 1 --tolerance 0 x.f64", "tolerance"),
        ("--truth 1 --tolerance 1e-15 x.f64", "rounding"),
        ("--truth 1 --alpha 2 x.f64", "alpha"),
        ("x.f64", "--truth"),
        ("--truth 1 --case case.toml --estimator ratio x.f64", "cannot be used with"),
        ("--case case.toml x.f64", "--estimator"),
        ("--case nowhere.toml --estimator ratio x.f64", "nowhere.toml"),
        ("--case case.toml --estimator ratoi x.f64", "choose one of: ratio"),
        ("--case case.toml --estimator ratio x.f64", "several estimators"),
        ("--case case.toml --estimator woodcock x.f64", "0.8, 1"),
        (
            "--case case.toml --estimator woodcock --swept 0.4 x.f64",
            "the nearest value of the sweep is 0.8",
        ),
        ("--case case.toml --estimator closed-form x.f64", "no estimator"),
    ] {
        place.expect(2, arguments, &[word]);
    }
    place.expect(1, "--truth 1 names.csv", &["numeric"]);
}

/// Returns a case and draws of its first experiment, made in this process.
fn drawn(case: &Case, draws: u64) -> (Vec<f64>, serde_json::Value) {
    let options = Options { draws: Amount::Exactly(draws), ..Options::default() };
    let plan = Plan::new(std::slice::from_ref(case), &options);
    let record = build::judged(&plan, &run::draw(&plan, &|_| {}), 0.0);
    let planned = &plan.cases[0].experiments[1];
    let ready = planned.outcome.as_ref().expect("it is drawn");
    let (mut values, mut buffer) = (Vec::new(), DrawBuffer::new(1));
    for block in 0..draws.div_ceil(BLOCK) {
        let mut streams = planned.streams(block);
        for _ in 0..BLOCK / DrawBuffer::LENGTH as u64 {
            ready.experiment.fill(&mut streams, DrawBuffer::LENGTH, &mut buffer);
            values.extend_from_slice(&buffer.values[0]);
        }
    }
    let row = record.results.rows().nth(1).expect("a row");
    let findings: Vec<&Finding> = row.findings().collect();
    let row = serde_json::json!({
        "verdict": row.verdict, "truth": row.truth, "findings": findings,
    });
    (values, row)
}

#[test]
fn theory_judges_the_library_s_own_draws() {
    let place = Place::new(&[("case.toml", CASE.as_bytes())]);
    let source = CaseText::read(&place.path().join("case.toml")).expect("a case");
    let case = Case::read(&source).expect("no mistakes");
    let n = 20 * BLOCK;
    let (values, row) = drawn(&case, n);
    std::fs::write(place.path().join("x.f64"), raw(&values)).expect("written");
    place.expect(2, "--case case.toml --estimator ratio --swept 1 x.f64", &["`ratio`"]);
    let one = CASE.replace("{ ratio = { sampling.constant.value = 2.0 } }, ", "");
    std::fs::write(place.path().join("case.toml"), one).expect("written");
    let arguments = "--case case.toml --estimator ratio --swept 1";
    place.expect(0, &format!("{arguments} x.f64"), &["pass"]);
    let found = place.json(&format!("{arguments} x.f64"), &[]);
    assert_eq!(row["verdict"], found["verdict"]);
    assert_eq!(row["truth"], found["truth"]);
    let gate = &row["findings"][0]["gate"];
    let close = |a: &serde_json::Value, b: &serde_json::Value| {
        let (a, b) = (a.as_f64().expect("a number"), b.as_f64().expect("a number"));
        (a - b).abs() <= 1e-9 * a.abs()
    };
    for key in ["tolerance", "variance"] {
        assert!(close(&gate[key], &found["findings"][0]["gate"][key]), "{key}");
    }
    place.expect(1, "--case case.toml --estimator ratio --swept 0.8 x.f64", &["the variance"]);
}

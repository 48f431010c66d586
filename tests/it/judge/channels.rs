//! Draws with several values: all channels of a case from one file, or one column of it.

use trueflight::OfCase;
use trueflight::rng::Address;
use trueflight::stats::verdict::Verdict;

use super::{Place, npy, raw};

const FIELD: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/field/03-channels-in-one-file");
const NAMES: [&str; 3] = ["channel 1", "channel 2", "channel 3"];
/// Case with three extinctions on [0, 2], each with an equal σ̂: the transmittances are those of depths 0.5, 1 and 2.
const CASE: &str = "title = \"three colours\"
[problem.transmittance]
medium = [ { constant.extinction = 0.25 }, { constant.extinction = 0.5 }, { constant.extinction = 1 } ]
span = [0, 2]
sampling = [{ constant.value = 0.25 }, { constant.value = 0.5 }, { constant.value = 1 }]
estimators = [{ independent = {} }]
";
const DEPTHS: [f64; 3] = [0.5, 1.0, 2.0];
const N: usize = 300_000;
/// Tolerances that the draws pass by far.
const WIDE: &str = "--tolerance 0.05 --variance-tolerance 0.2";

/// Returns draws of `independent`: a random channel scores 3 if nothing collides, the others score 0.
fn draws(seed: u64) -> Vec<[f64; 3]> {
    let mut rng = Address { seed, experiment: 3, block: 0, lane: 0 }.stream();
    let mut draw = || {
        let place = 3.0 * rng.uniform();
        let channel = usize::from(place >= 1.0) + usize::from(place >= 2.0);
        let passes = -rng.positive_uniform().ln() > DEPTHS[channel];
        let mut values = [0.0; 3];
        values[channel] = if passes { 3.0 } else { 0.0 };
        values
    };
    (0..N).map(|_| draw()).collect()
}

fn rows(draws: &[[f64; 3]]) -> Vec<f64> {
    draws.iter().flatten().copied().collect()
}

fn table(head: &str, draws: &[[f64; 3]], order: [usize; 3]) -> Vec<u8> {
    let line = |(i, x): (usize, &[f64; 3])| {
        format!("{i},{:?},{:?},{:?}\n", x[order[0]], x[order[1]], x[order[2]])
    };
    (head.to_owned() + &draws.iter().enumerate().map(line).collect::<String>()).into_bytes()
}

#[test]
fn all_channels_are_judged_as_one_draw() {
    let place = Place::new(&[]);
    let judge = format!("--case {FIELD}/three.toml --estimator spectral-mis {FIELD}/draws.npy");
    // 4,000 draws are too few for a tolerance of 5 %, but nothing is wrong with them.
    place.expect(3, &judge, &["3 inconclusive of 3 channels", "channel 1, channel 2, channel 3"]);
    let found = place.json(&judge, &[]);
    assert_eq!((&found["verdict"], &found["alpha"]), (&"inconclusive".into(), &1e-3.into()));
    let channels = found["channels"].as_array().expect("a list");
    for (channel, name) in channels.iter().zip(NAMES) {
        assert_eq!(channel["channel"], name);
        let judgement = &channel["judgement"];
        assert!(judgement["z"].as_f64().is_some_and(|z| z.abs() < 4.0), "{judgement}");
        assert!((judgement["alpha"].as_f64().expect("α") - 1e-3 / 3.0).abs() < 1e-18);
    }
    assert_eq!(channels.len(), 3);
}

#[test]
fn every_format_gives_the_same_verdict_on_all_channels() {
    let draws = draws(1);
    let shape = format!("({N}, 3)");
    let columns: Vec<f64> = (0..3).flat_map(|k| draws.iter().map(move |x| x[k])).collect();
    let by_column = npy("<f8", &shape, &raw(&columns));
    let by_column = String::from_utf8_lossy(&by_column[..128]).replace("False", "True ");
    let fortran = [by_column.as_bytes().to_vec(), raw(&columns)].concat();
    // The first byte of the header is not text.
    let fortran = [b"\x93", &fortran["\u{fffd}".len()..]].concat();
    let place = Place::new(&[
        ("three.toml", CASE.as_bytes()),
        ("x.npy", &npy("<f8", &shape, &raw(&rows(&draws)))),
        ("fortran.npy", &fortran),
        ("named.csv", &table("id,channel 3,channel 1,channel 2\n", &draws, [2, 0, 1])),
        (
            "rgb.csv",
            &String::from_utf8(table("", &draws, [0, 1, 2]))
                .expect("text")
                .lines()
                .fold(String::from("r,g,b\n"), |text, line| {
                    text + line.split_once(',').expect("an index").1 + "\n"
                })
                .into_bytes(),
        ),
    ]);
    let judge = format!("--case three.toml --estimator independent {WIDE}");
    place.expect(0, &format!("{judge} x.npy"), &["pass: 3 pass of 3 channels of x.npy"]);
    let expected = place.json(&format!("{judge} x.npy"), &[]);
    for file in ["fortran.npy", "named.csv", "rgb.csv"] {
        assert_eq!(place.json(&format!("{judge} {file}"), &[]), expected, "{file}");
    }
}

#[test]
fn a_column_of_an_array_is_judged_by_itself() {
    let draws = draws(2);
    let place = Place::new(&[
        ("x.npy", &npy("<f8", &format!("({N}, 3)"), &raw(&rows(&draws)))),
        ("x.f64", &raw(&rows(&draws))),
        ("x.csv", &table("id,r,g,b\n", &draws, [0, 1, 2])),
    ]);
    // 3T − T² and the fourth moment of 3 with probability T/3.
    let known = |depth: f64| {
        let p = (-depth).exp() / 3.0;
        let kurtosis = (1.0 - 3.0 * p * (1.0 - p)) / (p * (1.0 - p));
        let variance = 9.0 * p * (1.0 - p);
        format!("--truth {} --variance {variance} --kurtosis {kurtosis} {WIDE}", 3.0 * p)
    };
    for (column, depth) in DEPTHS.into_iter().enumerate() {
        place.expect(0, &format!("{} --column {column} x.npy", known(depth)), &["pass"]);
        place.expect(0, &format!("{} --column {} x.csv", known(depth), column + 1), &["pass"]);
        let other = known(if column == 1 { 0.5 } else { 1.0 });
        place.expect(1, &format!("{other} --column {column} x.npy"), &["is off"]);
    }
    let truth = |depth: f64| format!("--truth {} --range 0,3", (-depth).exp());
    place.expect(2, &format!("{} --column 3 x.npy", truth(1.0)), &["no column 3", "0, 1, 2"]);
    place.expect(2, &format!("{} --column r x.npy", truth(1.0)), &["no column `r`"]);
    place.expect(2, &format!("{} x.npy", truth(1.0)), &["--column"]);
    place.expect(2, &format!("{} --column 0 x.f64", truth(1.0)), &["raw numbers have no columns"]);
}

#[test]
fn a_channel_is_taken_from_a_file_of_all_or_of_one() {
    let draws = draws(3);
    let second: Vec<f64> = draws.iter().map(|x| x[1]).collect();
    // A name without a blank, for the arguments of these tests.
    let place = Place::new(&[
        ("three.toml", CASE.as_bytes()),
        ("x.npy", &npy("<f8", &format!("({N}, 3)"), &raw(&rows(&draws)))),
        ("one.npy", &npy("<f8", &format!("({N},)"), &raw(&second))),
        ("one.f64", &raw(&second)),
    ]);
    let judged = |more: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("trueflight").expect("the binary");
        command.current_dir(place.path()).env("COLUMNS", "400").args([
            "judge",
            "--case",
            "three.toml",
        ]);
        command.args(WIDE.split_whitespace());
        let output = command.args(["--estimator", "independent", "--format", "json"]).args(more);
        let output = output.output().expect("it runs");
        let value: Option<serde_json::Value> = serde_json::from_slice(&output.stdout).ok();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), value, error)
    };
    let channel = ["--channel", "channel 2"];
    let (code, expected, _) = judged(&[&channel[..], &["x.npy"]].concat());
    assert_eq!(code, Some(0));
    assert_eq!(expected.as_ref().expect("JSON")["truth"], (-1f64).exp());
    for more in [vec!["one.npy"], vec!["one.f64"], vec!["--column", "1", "x.npy"]] {
        assert_eq!(
            judged(&[&channel[..], &more].concat()),
            (Some(0), expected.clone(), String::new())
        );
    }
    // Mismatches are reported with the cure.
    for (more, words) in [
        (vec!["one.npy"], "a draw has 1 value, but the case has the channels channel 1, channel 2"),
        (vec!["one.f64"], "numbers without a shape do not tell how many values"),
        (vec!["--column", "1", "x.npy"], "say which, by --channel"),
        (vec!["--channel", "channel 4", "x.npy"], "a draw has 4 channels; choose one of"),
        (
            vec!["--channel", "luminance", "x.npy"],
            "write draws of 4 values, or 3 without the luminance",
        ),
    ] {
        let (code, _, error) = judged(&more);
        assert_eq!(code, Some(2), "{more:?}");
        assert!(error.contains(words) && error.matches("error:").count() == 1, "{more:?}: {error}");
    }
}

#[test]
fn a_wrong_channel_is_named_and_fails_the_file() {
    let mut wrong = draws(5);
    for x in &mut wrong {
        x[1] *= 1.1;
    }
    let place = Place::new(&[
        ("three.toml", CASE.as_bytes()),
        ("x.npy", &npy("<f8", &format!("({N}, 3)"), &raw(&rows(&wrong)))),
    ]);
    let judge = "--case three.toml --estimator independent --junit report.xml x.npy";
    place.expect(1, judge, &["fail of 3 channels of x.npy (channel 1, channel 2, channel 3)"]);
    let found = place.json(judge, &[]);
    assert_eq!(found["channels"][1]["judgement"]["verdict"], "fail");
    let report = std::fs::read_to_string(place.path().join("report.xml")).expect("a report");
    assert!(report.contains("name=\"channel 2 of x.npy\""), "{report}");
    assert!(!report.contains("failures=\"0\""), "{report}");
}

#[test]
fn checks_in_memory_take_draws_without_their_luminance() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let path = folder.path().join("three.toml");
    std::fs::write(&path, CASE).expect("written");
    let path = path.display().to_string();
    let mut draws = draws(6);
    let claim = || {
        trueflight::claim("colours")
            .of(&path, "independent", None)
            .values(3)
            .tolerance(0.05)
            .variance_tolerance(0.2)
    };
    let outcome = claim().judge(&rows(&draws)).expect("a verdict");
    assert_eq!(outcome.verdict(), Verdict::Pass, "{outcome}");
    assert_eq!(outcome.channels, NAMES);
    for x in &mut draws {
        x[2] *= 1.2;
    }
    let reason = claim().judge(&rows(&draws)).expect("a verdict").reason();
    assert!(reason.contains("channel 3: the "), "{reason}");
    let error = claim().values(2).judge(&rows(&draws)).expect_err("two values").to_string();
    let words = "a draw has 2 values, but the case has 4 channels (channel 1, channel 2, channel 3, luminance); give draws \
                 of 4 values, or 3 without the luminance";
    assert!(error.contains(words), "{error}");
}

#[test]
fn channels_that_are_right_by_themselves_fail_if_they_do_not_belong_together() {
    let bytes = std::fs::read(format!("{FIELD}/draws.npy")).expect("an array");
    let (head, body) = bytes.split_at(128);
    let rows = body.len() / 24;
    let value = |row: usize, k: usize| &body[24 * (row % rows) + 8 * k..][..8];
    // The second channel is shifted by one draw.
    let moved: Vec<u8> =
        (0..rows).flat_map(|i| [value(i, 0), value(i + 1, 1), value(i, 2)].concat()).collect();
    let place = Place::new(&[("moved.npy", &[head, &moved].concat())]);
    let judge = format!("--case {FIELD}/three.toml --estimator spectral-mis");
    place.expect(
        1,
        &format!("{judge} moved.npy"),
        &["the covariance with channel 1 of channel 2 differs from theory"],
    );
    let found = place.json(&format!("{judge} {FIELD}/draws.npy"), &[]);
    for test in found["channels"][0]["judgement"]["distribution"].as_array().expect("a list") {
        assert_eq!((&test["check"], &test["verdict"]), (&"covariance".into(), &"pass".into()));
    }
}

//! Every report of one fixed record, byte for byte.
//!
//! `UPDATE_GOLDEN=1 cargo test --test golden` rewrites the files; look at what changed before you
//! commit it.

use std::path::{Path, PathBuf};
use std::{env, fs};

use trueflight::harness::record::{
    Anatomy, CaseRecord, Curve, CurvePoint, MeasuredPoint, Record, Results, Row, Sweep, Timing,
    Verdict,
};
use trueflight::report::console::{self, View};
use trueflight::report::{self, rows};

/// Made-up laws of variance and lookups against the sampling extinction.
fn law(estimator: &str, sampling: f64) -> (f64, f64) {
    match estimator {
        "woodcock" => (0.125, 2.0 * sampling),
        "residual-ratio" => (0.02 / sampling, 5.0 * sampling),
        _ => (0.05 / sampling + 0.01 * sampling, 4.0 * sampling),
    }
}

/// One point of a sweep, with round numbers.
fn drawn(estimator: &str, control: &str, swept: f64, z: f64) -> Row {
    let (variance, lookups) = law(estimator, swept);
    Row {
        estimator: estimator.to_owned(),
        sampling: Some(swept),
        sampling_kind: "constant".to_owned(),
        control: control.to_owned(),
        swept: Some(swept),
        draws: Some(1_048_576),
        mean: Some(0.135 + 1e-4 * z),
        standard_error: Some(1e-4),
        truth: Some(0.135),
        truth_error: Some(1e-17),
        z_mean: Some(z),
        variance: Some(variance * 1.01),
        predicted_variance: Some(variance),
        z_variance: Some(1.25),
        variance_deviation: Some(variance * 0.008),
        lookups_per_draw: Some(lookups * 0.999),
        predicted_lookups: Some(lookups),
        z_lookups: Some(-0.5),
        lookups_deviation: Some(lookups * 0.002),
        losses: Some([2.0, 1.5, 1.25, 1.125]),
        relative_moments: [Some(3.5), Some(12.25), None],
        lookups_variance: Some(lookups),
        lookups_pmf: vec![0.25, 0.5, 0.25],
        rare_event_size: Some(15.5),
        predicted_skewness: Some(0.75),
        predicted_kurtosis: Some(12.5),
        detectable_bias: Some(0.003),
        fom: Some(1.0 / (variance * lookups)),
        predicted_fom: Some(1.0 / (variance * lookups)),
        stable_share: Some(0.8),
        best_sampling: Some(1.2),
        best_fom: Some(2.5),
        verdict: Some(Verdict::Pass),
        ..Row::default()
    }
}

fn judged(mut row: Row, verdict: Verdict, reason: &str) -> Row {
    row.verdict = Some(verdict);
    reason.clone_into(&mut row.reason);
    row
}

fn refused(estimator: &str, swept: f64) -> Row {
    let row = Row {
        estimator: estimator.to_owned(),
        sampling: Some(swept),
        swept: Some(swept),
        ..Row::default()
    };
    let reason = "the majorant is 0.9: below it the chance of a real collision would exceed 1";
    judged(row, Verdict::Refused, reason)
}

fn sweep() -> CaseRecord {
    let (single, doubt) = ("single(non-terminating, a=0.7)", "at 1e6 draws a bias of 3 % hides");
    let failed = drawn("residual-ratio", "constant 0.4", 2.0, 7.5);
    let regular = Row {
        estimator: "regular".to_owned(),
        draws: Some(1),
        mean: Some(0.135),
        truth: Some(0.135),
        variance: Some(0.0),
        predicted_variance: Some(0.0),
        lookups_per_draw: Some(12.0),
        predicted_lookups: Some(12.0),
        verdict: Some(Verdict::Pass),
        ..Row::default()
    };
    let curve = |estimator: &str, control: &str, from: f64, optimum: Option<f64>| {
        let point = |x: f64| {
            let (variance, lookups) = law(estimator, x);
            CurvePoint { x, variance, lookups, fom: 1.0 / (variance * lookups) }
        };
        Curve {
            estimator: estimator.to_owned(),
            control: control.to_owned(),
            points: [0.5, 0.75, 1.0, 1.5, 2.0]
                .into_iter()
                .filter(|x| *x >= from)
                .map(point)
                .collect(),
            optimum: optimum.map(point),
        }
    };
    CaseRecord {
        name: "transmittance/eq21-sweep".to_owned(),
        title: "Eq. 21, central ray, \"quoted\" & <tagged>".to_owned(),
        problem: "transmittance".to_owned(),
        medium: "eq21".to_owned(),
        rows: vec![
            refused("woodcock", 0.5),
            drawn("residual-ratio", "constant 0.4", 0.5, 0.25),
            judged(drawn(single, "", 0.5, -1.5), Verdict::Inconclusive, doubt),
            drawn("woodcock", "", 2.0, 1.0),
            judged(failed, Verdict::Fail, "the mean is 7.5 standard errors off; 4.4 are allowed"),
            judged(drawn(single, "", 2.0, -0.125), Verdict::Inconclusive, doubt),
            regular,
        ],
        sweep: Some(Sweep {
            what: "sampling".to_owned(),
            axis: "sampling extinction σ\u{302} [1/length]".to_owned(),
            log: true,
            z_limit: Some(4.42),
            curves: vec![
                curve("woodcock", "", 1.0, Some(1.0)),
                curve("residual-ratio", "constant 0.4", 0.5, None),
                curve(single, "", 0.5, Some(1.5)),
            ],
        }),
        anatomy: None,
    }
}

fn ray() -> CaseRecord {
    let transmittance = vec![1.0, 0.7, 0.4, 0.3, 0.28];
    let channel = |t: f64, mean: f64| Row {
        channel: format!("T({t})"),
        truth: Some(mean),
        sampling: None,
        sampling_kind: "piecewise-linear".to_owned(),
        swept: None,
        ..drawn("double", "explorers(3)", 1.0, 0.5)
    };
    let weak = "kurtosis 8.1e4: 3e9 draws would be needed";
    let measured = |t, mean| MeasuredPoint { t, mean, standard_error: 0.01, deviation: 0.1 };
    CaseRecord {
        name: "curve/figure5".to_owned(),
        title: "Figure 5: a double particle".to_owned(),
        problem: "transmittance-curve".to_owned(),
        medium: "noise".to_owned(),
        rows: vec![channel(2.0, 0.4), judged(channel(4.0, 0.28), Verdict::Underpowered, weak)],
        sweep: None,
        anatomy: Some(Anatomy {
            estimator: "double, explorers(3)".to_owned(),
            t: vec![0.0, 1.0, 2.0, 3.0, 4.0],
            extinction: vec![0.2, 0.5, 0.6, 0.3, 0.1],
            control: vec![0.2, 0.4, 0.6, 0.35, 0.1],
            residual: vec![0.0, 0.1, 0.0, -0.05, 0.0],
            sampling: vec![0.25; 5],
            deviation: vec![0.0, 0.05, 0.1, 0.1, 0.1],
            explorers: vec![[0.0, 0.2], [2.0, 0.6], [4.0, 0.1]],
            collisions: vec![[0.75, 0.43], [3.2, 0.26]],
            walks: vec![vec![1.0, 0.65, 0.35, 0.3, 0.3], vec![1.0, 0.8, 0.5, -20.0, 0.2]],
            measured: vec![measured(2.0, 0.41), measured(4.0, 0.27)],
            transmittance,
        }),
    }
}

fn record() -> Record {
    let results = Results {
        version: "0.1.0".to_owned(),
        seed: 1,
        alpha: 0.01,
        checks: 21,
        cut_by_time: false,
        cases: vec![sweep(), ray()],
    };
    let mut first = vec![Some(0.25); 7];
    first[0] = None;
    let rows = vec![first, vec![Some(0.5); 2]];
    Record { results, timing: Timing { threads: 2, seconds: 2.25, rows } }
}

/// Compares with the committed file of this name, or rewrites it.
fn compare(name: &Path, bytes: &[u8]) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name);
    if env::var_os("UPDATE_GOLDEN").is_some() {
        let folder = path.parent().expect("a golden file has a folder");
        fs::create_dir_all(folder).expect("the folder can be made");
        fs::write(&path, bytes).expect("the golden file can be written");
    }
    let golden = fs::read(&path).unwrap_or_default();
    if golden != bytes {
        let (golden, now) = (String::from_utf8_lossy(&golden), String::from_utf8_lossy(bytes));
        let mut pairs = golden.lines().zip(now.lines()).enumerate();
        let first = pairs.find(|(_, (old, new))| old != new);
        panic!("{} differs, first at {first:#?}", path.display());
    }
}

#[test]
fn files() {
    let artifacts = report::render(&record()).expect("renders");
    for artifact in &artifacts {
        if artifact.path.extension().is_some_and(|ending| ending == "png") {
            assert!(
                artifact.bytes.starts_with(b"\x89PNG\r\n\x1a\n"),
                "{}",
                artifact.path.display()
            );
            let width = u32::from_be_bytes(artifact.bytes[16..20].try_into().expect("a header"));
            assert_eq!(width, 1800);
            continue;
        }
        compare(&artifact.path, &artifact.bytes);
    }
    assert_eq!(artifacts.len(), 9);
}

#[test]
fn rows_on_stdout() {
    let (csv, json) = (rows::csv(&record()), rows::json(&record()));
    compare(&PathBuf::from("rows.csv"), csv.expect("renders").as_bytes());
    let json = json.expect("renders");
    compare(&PathBuf::from("rows.json"), json.as_bytes());
    let parsed: serde_json::Value = serde_json::from_str(&json).expect("is JSON");
    assert_eq!(parsed.as_array().map(Vec::len), Some(9));
}

#[test]
fn consoles() {
    let views = [
        ("run", View::Run),
        ("predict", View::Predict),
        ("moments", View::Moments),
        ("plan", View::Plan),
    ];
    for (name, view) in views {
        for width in [80, 160] {
            let text = console::table(&record(), view, width, false);
            let widest = text.lines().map(|line| line.chars().count()).max();
            // A combining hat is a character without width.
            assert!(widest.is_some_and(|widest| widest <= width + 2), "{name} at {width}");
            compare(&PathBuf::from(format!("console-{name}-{width}.txt")), text.as_bytes());
        }
    }
}

#[test]
fn colours_change_nothing_but_the_colour() {
    let [plain, coloured] = [false, true].map(|c| console::table(&record(), View::Run, 100, c));
    assert!(coloured.contains("\x1b[1;31mfail\x1b[0m"));
    let mut stripped = coloured;
    for code in ["0", "1", "2", "32", "1;31", "33"] {
        stripped = stripped.replace(&format!("\x1b[{code}m"), "");
    }
    assert_eq!(stripped, plain);
}

#[test]
fn nothing_is_too_odd_to_draw() {
    let mut record = record();
    let odd = [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, 5e-324];
    for value in odd {
        for case in &mut record.results.cases {
            for row in &mut case.rows {
                row.swept = row.swept.map(|_| value);
                row.variance = Some(value);
                row.z_mean = Some(value);
                row.variance_deviation = Some(value);
                row.fom = Some(value);
            }
            if let Some(sweep) = &mut case.sweep {
                sweep.z_limit = Some(value);
                for point in sweep.curves.iter_mut().flat_map(|curve| &mut curve.points) {
                    (point.x, point.variance) = (value, value);
                }
            }
            if let Some(anatomy) = &mut case.anatomy {
                anatomy.t[1] = value;
                anatomy.extinction[2] = value;
                anatomy.walks.push(vec![value]);
                anatomy.measured[0].deviation = value;
            }
        }
        report::render(&record).expect("renders");
    }
    for case in &mut record.results.cases {
        case.rows.clear();
        if let Some(sweep) = &mut case.sweep {
            sweep.curves.clear();
        }
    }
    report::render(&record).expect("renders");
}

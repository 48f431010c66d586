//! Every report of one fixed record, byte for byte.
//!
//! `UPDATE_GOLDEN=1 cargo test --test it golden` rewrites the files; look at what changed before you
//! commit it.

mod bench;
pub mod record;

use std::path::{Path, PathBuf};
use std::{env, fs};

use record::record;
use trueflight::report::console::{self, View, layout::Pen};
use trueflight::report::junit::Inconclusive;
use trueflight::report::{self, annotations, junit, markdown, rows};

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
        // The page has tests of its own (`html/`): its bytes are its style and its script for the most part.
        if artifact.path.extension().is_some_and(|ending| ending == "html") {
            continue;
        }
        compare(&artifact.path, &artifact.bytes);
    }
    assert_eq!(artifacts.len(), 12);
}

#[test]
fn rows_on_stdout() {
    let (csv, json) = (rows::csv(&record()), rows::json(&record()));
    compare(&PathBuf::from("rows.csv"), csv.expect("renders").as_bytes());
    let json = json.expect("renders");
    compare(&PathBuf::from("rows.json"), json.as_bytes());
    let parsed: serde_json::Value = serde_json::from_str(&json).expect("is JSON");
    assert_eq!(parsed.as_array().map(Vec::len), Some(11));
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
            let text = console::table(&record(), view, Pen { width, colour: false });
            // A command stays whole, so that it can be copied.
            let is_command = |line: &str| line.contains(": trueflight ");
            let wrapped = text.lines().filter(|line| !is_command(line));
            let widest = wrapped.map(|line| line.chars().count()).max();
            // A combining hat is a character without width.
            assert!(widest.is_some_and(|widest| widest <= width + 2), "{name} at {width}");
            compare(&PathBuf::from(format!("console-{name}-{width}.txt")), text.as_bytes());
        }
    }
}

#[test]
fn what_a_ci_reads() {
    let record = record();
    let xml = junit::text(&record, Inconclusive::Error).expect("renders");
    compare(&PathBuf::from("junit.xml"), xml.as_bytes());
    compare(&PathBuf::from("summary.md"), markdown::text(&record).as_bytes());
    compare(&PathBuf::from("annotations.txt"), annotations::text(&record).as_bytes());
    compare(
        &PathBuf::from("check.txt"),
        console::brief(&record, Pen { width: 100, colour: false }).as_bytes(),
    );
}

#[test]
fn github_shows_no_more_than_ten_of_a_kind() {
    let mut record = record();
    let case = record.results.cases[0].clone();
    record.results.cases = vec![case; 11];
    let text = annotations::text(&record);
    let of = |kind: &str| text.lines().filter(|line| line.starts_with(kind)).count();
    assert_eq!((of("::error "), of("::warning ")), (10, 10), "{text}");
    assert!(text.contains("and 5 more") && text.contains("and 13 more"), "{text}");
}

#[test]
fn infinite_numbers_do_not_break_the_json() {
    let mut record = record();
    record.results.gate.smallest_margin = Some(f64::NEG_INFINITY);
    let text = report::record_json::text(&record).expect("renders");
    assert!(text.starts_with("{\"schema\":"), "{text}");
    let parsed: serde_json::Value = serde_json::from_str(&text).expect("is JSON");
    let gate = &parsed["results"]["cases"][0]["rows"][2]["findings"][0]["gate"];
    assert_eq!(gate["needed"], serde_json::Value::Null);
    assert_eq!(gate["tolerance"], 0.003);
}

#[test]
fn colours_change_nothing_but_the_colour() {
    let [plain, coloured] = [false, true]
        .map(|colour| console::table(&record(), View::Run, Pen { width: 100, colour }));
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

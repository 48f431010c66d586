//! Reports of one fixed record: one file of each format byte for byte, and properties of the others.
//!
//! `UPDATE_GOLDEN=1 cargo test --test it golden` rewrites the files; look at the changes before you commit them.

mod bench;

use std::path::Path;
use std::{env, fs};

use quick_xml::events::Event;
use trueflight::case::id::Number;
use trueflight::record::{Record, Verdict};
use trueflight::report::Artifact;
use trueflight::report::layout::Pen;
use trueflight::report::run::console::{self, TableView};
use trueflight::report::run::junit::Inconclusive;
use trueflight::report::run::{self, annotations, junit, markdown, record_json, summary_csv};

/// Returns a stored record with every kind of content of reports.
pub fn record() -> Record {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden/record.json");
    let bytes = fs::read(path).expect("the golden record");
    record_json::read(&bytes[..]).expect("a record")
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

/// Files of which one record is enough to show the format, byte for byte.
const SHOWN: [&str; 6] = [
    "changes.csv",
    "summary.csv",
    "checks.csv",
    "record.json",
    "curve/figure5.anatomy.csv",
    "transmittance/eq21-sweep.theory.csv",
];

/// Asserts that a picture is complete: an SVG is well-formed and has numbers only, a PNG has its size.
fn assert_drawn(artifact: &Artifact, width: u32) {
    let name = artifact.path.display();
    if artifact.path.extension().is_some_and(|ending| ending == "png") {
        assert!(artifact.bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "{name}");
        let found = u32::from_be_bytes(artifact.bytes[16..20].try_into().expect("a header"));
        assert_eq!(found, width, "{name}");
        return;
    }
    let text = String::from_utf8(artifact.bytes.clone()).expect("text");
    let mut reader = quick_xml::Reader::from_str(&text);
    let (mut depth, mut shapes) = (0, 0);
    loop {
        match reader.read_event().unwrap_or_else(|error| panic!("{name}: {error}")) {
            Event::Start(_) => (depth, shapes) = (depth + 1, shapes + 1),
            Event::End(_) => depth -= 1,
            Event::Eof => break,
            _ => {}
        }
    }
    assert!(depth == 0 && shapes > 10, "{name}: {shapes} shapes, {depth} elements are open");
    assert!(!["NaN", "inf"].iter().any(|word| text.contains(&format!("\"{word}"))), "{name}");
}

#[test]
fn files() {
    let artifacts = run::render(&record()).expect("renders");
    let mut compared = 0;
    for artifact in &artifacts {
        let ending = artifact.path.extension().unwrap_or_default();
        if ending == "png" || ending == "svg" {
            assert_drawn(artifact, 1800);
        } else if SHOWN.iter().any(|name| artifact.path == Path::new(name)) {
            compare(&artifact.path, &artifact.bytes);
            compared += 1;
        }
    }
    assert_eq!((artifacts.len(), compared), (13, SHOWN.len()));
}

#[test]
fn the_manual_has_every_column() {
    compare(Path::new("../../docs/columns.md"), lab::report::columns().as_bytes());
}

#[test]
fn rows_on_stdout_are_those_of_the_files() {
    let files = run::render(&record()).expect("renders");
    let summary = files.iter().find(|file| file.path == Path::new("summary.csv")).expect("a file");
    let csv = summary_csv::csv(&record()).expect("renders");
    assert_eq!(csv.as_bytes(), summary.bytes);
    let json = summary_csv::json(&record()).expect("renders");
    let parsed: Vec<serde_json::Map<String, serde_json::Value>> =
        serde_json::from_str(&json).expect("is JSON");
    assert_eq!(parsed.len(), 11);
    let mut header = csv.lines().next().expect("a line").split(',');
    assert!(header.all(|name| parsed[0].contains_key(name)), "{:?}", parsed[0].keys());
}

/// One console is compared byte for byte; no line of any is wider than the terminal.
#[test]
fn consoles() {
    for view in [TableView::Run, TableView::Predict, TableView::Moments, TableView::Plan] {
        for width in [80, 160] {
            let text = console::table(&record(), view, Pen { width, colour: false });
            // A command is on one line, so that it can be copied.
            let is_command = |line: &str| line.contains(": trueflight ");
            let wrapped = text.lines().filter(|line| !is_command(line));
            let widest = wrapped.map(|line| line.chars().count()).max();
            // A combining hat is a character without width.
            assert!(widest.is_some_and(|widest| widest <= width + 2), "{view:?} at {width}");
        }
    }
    let text = console::table(&record(), TableView::Run, Pen { width: 160, colour: false });
    compare(Path::new("console.txt"), text.as_bytes());
}

#[test]
fn what_a_ci_reads() {
    let record = record();
    let xml = junit::text(&record, Inconclusive::Error);
    compare(Path::new("junit.xml"), xml.as_bytes());
    compare(Path::new("summary.md"), markdown::text(&record).as_bytes());
    compare(Path::new("annotations.txt"), annotations::text(&record).as_bytes());
    // `check` lists every row that does not pass.
    let brief = console::brief(&record, Pen { width: 100, colour: false });
    for case in &record.results.cases {
        let is_open =
            |row: &trueflight::record::Row| !matches!(row.verdict, Some(Verdict::Pass) | None);
        let open = case.rows().filter(is_open);
        for row in open {
            let first = &row.experiment.label.split(' ').next().unwrap_or_default();
            assert!(brief.contains(first), "{}: {first} is missing in\n{brief}", case.name);
        }
    }
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
    let text = record_json::text(&record).expect("renders");
    assert!(text.starts_with("{\"schema\":"), "{text}");
    let parsed: serde_json::Value = serde_json::from_str(&text).expect("is JSON");
    let gate = &parsed["results"]["cases"][0]["experiments"][2]["findings"][0]["gate"];
    assert_eq!(gate["needed"], "inf");
    assert_eq!(gate["tolerance"], 0.003);
}

#[test]
fn colours_change_nothing_but_the_colour() {
    let [plain, coloured] = [false, true]
        .map(|colour| console::table(&record(), TableView::Run, Pen { width: 100, colour }));
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
            for one in &mut case.experiments {
                if let Some(point) = &mut one.id.swept {
                    point.value = Number(value);
                }
                for channel in &mut one.channels {
                    channel.variance = Some(value);
                    channel.z_mean = Some(value);
                    channel.variance_deviation = Some(value);
                    channel.fom = Some(value);
                }
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
        run::render(&record).expect("renders");
    }
    for case in &mut record.results.cases {
        case.experiments.clear();
        if let Some(sweep) = &mut case.sweep {
            sweep.curves.clear();
        }
    }
    run::render(&record).expect("renders");
}

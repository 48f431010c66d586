//! Cases written as text, read, predicted, drawn and judged.

pub mod grids;
pub mod lit;
pub mod mutated;
pub mod place;

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use trueflight::gate::CheckId;

use trueflight::case::Case;
use trueflight::case::CaseError;
use trueflight::case::CaseText;
use trueflight::catalogue::{Fault, Settings};
use trueflight::draw::run;
use trueflight::estimators::{DrawBuffer, Experiment, Kernel};
use trueflight::media::{Body, Medium};
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::record::Record;
use trueflight::record::build;
use trueflight::record::{Finding, Row, Verdict};
use trueflight::rng::Streams;

/// Level of every run in the tests, small enough that no false alarm occurs.
pub const ALPHA: f64 = 1e-6;

/// Makes a case of the given name and text.
pub fn source(name: &str, text: &str) -> CaseText {
    CaseText { name: name.into(), path: PathBuf::from(format!("{name}.toml")), text: text.into() }
}

/// Reads a case; panics with the rendered mistakes.
pub fn case(name: &str, text: &str) -> Case {
    Case::read(&source(name, text)).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Returns the mistakes that reading a case reports; `None` if it has none.
pub fn mistakes(text: &str) -> Option<CaseError> {
    Case::read(&source("broken", text)).err()
}

/// Returns options with a seed and a number of draws, at the level of the tests.
pub fn options(seed: u64, draws: u64) -> Options {
    Options { seed, draws: Amount::Exactly(draws), alpha: ALPHA, ..Options::default() }
}

/// Draws and judges cases.
pub fn judged(cases: &[Case], options: &Options) -> Record {
    let plan = Plan::new(cases, options);
    let draws = run::draw(&plan, &|_| {});
    build::judged(&plan, &draws, 0.0)
}

/// Returns all rows of a record, which stays in memory until the tests end.
pub fn rows_of(record: Record) -> Vec<Row<'static>> {
    Box::leak(Box::new(record)).results.rows().collect()
}

/// Draws and judges one case written as text, from seed 1.
pub fn rows(text: &str, draws: u64) -> Vec<Row<'static>> {
    rows_of(judged(&[case("test", text)], &options(1, draws)))
}

/// Returns the predictions of a case written as text, as `trueflight predict` shows them.
pub fn predicted(text: &str) -> Vec<Row<'static>> {
    let cases = [case("test", text)];
    let record = build::predicted(&Plan::new(&cases, &options(1, 1000)));
    rows_of(record)
}

/// Returns the predictions with the best σ̂ of each channel.
pub fn with_optima(text: &str) -> Vec<Row<'static>> {
    let cases = [case("test", text)];
    rows_of(build::predicted_with_optima(&Plan::new(&cases, &options(1, 1000))))
}

/// Returns the channels of the estimator of this name, or else of all estimators with this beginning.
pub fn channels<'a>(rows: &'a [Row<'static>], estimator: &str) -> Vec<&'a Row<'static>> {
    let of = |is_it: &dyn Fn(&str) -> bool| -> Vec<&'a Row<'static>> {
        rows.iter().filter(|row| is_it(&row.experiment.label)).collect()
    };
    let own = of(&|label| label == estimator);
    if own.is_empty() { of(&|label| label.starts_with(estimator)) } else { own }
}

/// Returns the row of the first estimator with this beginning.
pub fn row<'a>(rows: &'a [Row<'static>], estimator: &str) -> &'a Row<'static> {
    let mut found = rows.iter().filter(|row| row.experiment.label.starts_with(estimator));
    found.next().unwrap_or_else(|| panic!("no row of {estimator}"))
}

/// Lists the rows in which mean, variance or lookups do not pass, or were not tested.
pub fn failing(rows: &[Row]) -> Vec<String> {
    not_passing(rows, &[CheckId::Mean, CheckId::Variance, CheckId::Lookups])
}

/// Lists the rows in which these checks do not pass, or were not made.
pub fn not_passing(rows: &[Row], checks: &[CheckId]) -> Vec<String> {
    let mut wrong = Vec::new();
    for row in rows {
        let is_unasked = |check: &&CheckId| row.findings().all(|finding| finding.check != **check);
        let unasked: Vec<&CheckId> = checks.iter().filter(is_unasked).collect();
        if row.verdict != Some(Verdict::Pass) || !unasked.is_empty() {
            let (name, channel) = (&row.experiment.label, &row.channel);
            let verdict = row.verdict;
            wrong.push(format!(
                "{name} {channel}: {verdict:?}, {}, without {unasked:?}",
                row.reason()
            ));
        }
    }
    wrong
}

/// Returns the finding of a check in a row.
pub fn finding<'a>(row: &Row<'a>, check: CheckId) -> &'a Finding {
    let mut found = row.findings().filter(|finding| finding.check == check);
    found.next().unwrap_or_else(|| panic!("no {check} of {}", row.experiment.label))
}

/// Returns the verdict on a row.
pub fn verdict(row: &Row) -> Verdict {
    row.verdict.unwrap_or_else(|| panic!("no verdict on {}", row.experiment.label))
}

/// Reads the field along a line or ray, from the lines below the problem of a case in a folder.
pub fn try_body(text: &str, folder: &Path) -> Result<Body, Vec<Fault>> {
    let faults = RefCell::default();
    let root = source("medium", text).parse(&faults);
    let body = Body::read(&Settings::new(&root, folder, &faults));
    let faults = faults.into_inner();
    body.filter(|_| faults.is_empty()).ok_or(faults)
}

/// Returns the field of lines without mistakes.
pub fn body(text: &str) -> Body {
    let body = try_body(text, Path::new("tests/data"));
    body.unwrap_or_else(|faults| panic!("{text}: {faults:?}"))
}

/// Returns the field along the ray.
pub fn medium(text: &str) -> Medium {
    body(text).medium()
}

/// Folders of the repository's case files: those for readers, and those for tests alone.
pub const CASES: [&str; 2] = ["cases", "tests/cases"];

/// Finds the file of a case of the repository.
pub fn case_file(name: &str) -> PathBuf {
    let paths = CASES.map(|folder| {
        Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join(format!("{name}.toml"))
    });
    let found = paths.into_iter().find(|path| path.exists());
    found.unwrap_or_else(|| panic!("no case {name} in {CASES:?}"))
}

/// Reads every case file of the repository as text, in the order of the paths.
pub fn shipped_texts() -> Vec<String> {
    let mut folders: Vec<PathBuf> = CASES.iter().map(PathBuf::from).collect();
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "toml") {
                files.push(path);
            }
        }
    }
    files.sort();
    files.iter().map(|path| std::fs::read_to_string(path).expect("a text")).collect()
}

/// Reads every case file of the repository.
pub fn shipped() -> Vec<Case> {
    shipped_in(&[""])
}

/// Reads the repository's case files below folders of [`CASES`].
pub fn shipped_in(folders: &[&str]) -> Vec<Case> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let below = |cases: &str| folders.iter().map(|folder| root.join(cases).join(folder)).collect();
    let paths: Vec<Vec<PathBuf>> = CASES.iter().map(|cases| below(cases)).collect();
    let paths: Vec<PathBuf> = paths.concat().into_iter().filter(|path| path.is_dir()).collect();
    trueflight::Catalogue::builtin().read_all(&paths).unwrap_or_else(|errors| {
        let shown: Vec<String> = errors.iter().map(|error| error.render(false)).collect();
        panic!("{}", shown.join("\n\n"))
    })
}

/// Draws per experiment of the frozen values in `tests/lock`.
pub const LOCKED_DRAWS: u64 = 65_536;

/// Returns the draws per experiment of [`shipped_record`]; `TRUEFLIGHT_DRAWS` sets another number, for long campaigns.
pub fn shipped_draws() -> u64 {
    let wished = std::env::var("TRUEFLIGHT_DRAWS").ok();
    wished.map_or(LOCKED_DRAWS, |text| text.parse().expect("TRUEFLIGHT_DRAWS is a whole number"))
}

/// Returns the plan of all shipped cases from seed 1, made once for all tests.
pub fn shipped_plan() -> &'static Plan<'static> {
    static CASES: LazyLock<Vec<Case>> = LazyLock::new(shipped);
    static PLAN: LazyLock<Plan<'static>> =
        LazyLock::new(|| Plan::new(&CASES, &options(1, shipped_draws())));
    &PLAN
}

/// Returns the judged draws of that plan, made once for all tests.
pub fn shipped_record() -> &'static Record {
    static RECORD: LazyLock<Record> = LazyLock::new(|| {
        let plan = shipped_plan();
        build::judged(plan, &run::draw(plan, &|_| {}), 0.0)
    });
    &RECORD
}

/// Compares `found` with `expected` to a relative tolerance; returns a message if they differ.
pub fn differs(what: &str, found: f64, expected: f64, tolerance: f64) -> Option<String> {
    let error = (found - expected).abs();
    let same = found == expected || error <= tolerance * expected.abs();
    (!same).then(|| {
        let relative = error / expected.abs();
        format!("{what}: {found:e} against {expected:e}, {relative:.1e} > {tolerance:.1e}")
    })
}

/// Panics with all messages if there are any.
pub fn none(messages: &[String]) {
    assert!(messages.is_empty(), "{} differ:\n{}", messages.len(), messages.join("\n"));
}

/// Experiment that draws nothing, as a temporary replacement.
pub struct Nothing;

impl Experiment for Nothing {
    fn fill_by(&self, _: Kernel, _: &mut Streams, _: usize, _: &mut DrawBuffer) {}
}

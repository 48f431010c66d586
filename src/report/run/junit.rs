//! JUnit XML, which every CI service shows: one test suite per case, one test per experiment and channel.
//!
//! A fail is a `failure` with every number and the command that repeats it. Refused and underpowered experiments are
//! `skipped`. Inconclusive ones are an `error`, a `failure` or `skipped`, as asked for. The time is processor seconds;
//! if an experiment has several channels, the first has all of it. The form is that of the Jenkins schema
//! `junit-10.xsd`.

use std::time::Duration;

use quick_junit::{NonSuccessKind, TestCase, TestCaseStatus, TestSuite};

use crate::record::baseline::Comparison;
use crate::record::{CaseRecord, Record, Row, Verdict};
use crate::report::ReportError;
use crate::report::run::diff;
use crate::report::run::failures::{self, Failure};
use numeric::digits::number;

/// Result of an inconclusive experiment in JUnit.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Inconclusive {
    /// An `error`: the test could not do its work.
    #[default]
    Error,
    /// A `failure`.
    Failure,
    /// `skipped`: no CI service counts it as a failure.
    Skipped,
}

/// Returns the record as JUnit XML.
pub fn text(record: &Record, inconclusive: Inconclusive) -> Result<String, ReportError> {
    let mut report = quick_junit::Report::new("trueflight");
    report.set_time(duration(record.timing.seconds));
    for case in &record.results.cases {
        report.add_test_suite(suite(record, case, inconclusive));
    }
    if let Some(comparison) = &record.comparison {
        report.add_test_suite(changed(comparison));
    }
    encoded(&report)
}

fn suite(record: &Record, case: &CaseRecord, inconclusive: Inconclusive) -> TestSuite {
    let results = &record.results;
    let mut suite = TestSuite::new(&*case.name);
    for (name, value) in [
        ("title", case.title.clone()),
        ("seed", results.seed.to_string()),
        ("alpha", number(results.alpha)),
        ("version", results.version.clone()),
        ("schema", results.schema.to_string()),
    ] {
        suite.add_property((name, &*value));
    }
    let mut whole = Duration::ZERO;
    for row in case.rows() {
        let time = row.experiment.spent.seconds.filter(|_| row.is_first());
        let time = time.map_or(Duration::ZERO, duration);
        whole = whole.saturating_add(time);
        let status = status(row, results.seed, inconclusive);
        let mut test = TestCase::new(row.name(), status);
        test.set_classname(&*case.name).set_time(time);
        suite.add_test_case(test);
    }
    suite.set_time(whole);
    if !case.notes.is_empty() {
        suite.set_system_out(case.notes.join("\n"));
    }
    suite
}

/// Returns a suite for the changes since a stored run: a test for each change, or one that passes if nothing changed.
/// Its output is the extent of the comparison, and the experiments that were left out.
fn changed(comparison: &Comparison) -> TestSuite {
    let mut suite = TestSuite::new(format!("baseline {}", comparison.name));
    suite.set_system_out(diff::remarks(comparison).join("\n"));
    let all = diff::all(comparison);
    if let Some(nothing) = diff::nothing(comparison) {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_type("nothing").set_message(nothing);
        suite.add_test_case(TestCase::new("something was compared", status));
    } else if !all.iter().any(|change| change.is_worse) {
        suite.add_test_case(TestCase::new("nothing became worse", TestCaseStatus::success()));
    }
    for change in all.iter().filter(|change| change.is_worse) {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        status.set_type("regression").set_message(change.what());
        status.set_description(format!("{}\nrepeat: {}\n", change.line(), change.command));
        suite.add_test_case(TestCase::new(change.experiment.as_str(), status));
    }
    suite
}

fn status(row: Row, seed: u64, inconclusive: Inconclusive) -> TestCaseStatus {
    let details = || {
        let details = failures::of_row(row, seed);
        details.iter().map(Failure::details).collect::<Vec<_>>().join("\n")
    };
    status_of(row.verdict.unwrap_or(Verdict::Pass), &row.reason, inconclusive, details)
}

/// Returns the status of a verdict with its reason; a fail or an inconclusive verdict has details.
pub fn status_of(
    verdict: Verdict,
    reason: &str,
    inconclusive: Inconclusive,
    details: impl FnOnce() -> String,
) -> TestCaseStatus {
    let mut status = match (verdict, inconclusive) {
        (Verdict::Pass, _) => return TestCaseStatus::success(),
        (Verdict::Fail, _) | (Verdict::Inconclusive, Inconclusive::Failure) => {
            TestCaseStatus::non_success(NonSuccessKind::Failure)
        }
        (Verdict::Inconclusive, Inconclusive::Error) => {
            TestCaseStatus::non_success(NonSuccessKind::Error)
        }
        _ => TestCaseStatus::skipped(),
    };
    status.set_type(verdict.word());
    status.set_message(reason);
    if matches!(verdict, Verdict::Fail | Verdict::Inconclusive) {
        status.set_description(details());
    }
    status
}

/// Returns the report as text. The schema has no count of skipped tests at the root; the suites have theirs.
pub fn encoded(report: &quick_junit::Report) -> Result<String, ReportError> {
    let skipped = format!(" skipped=\"{}\"", report.skipped);
    Ok(report.to_string()?.replacen(&skipped, "", 1))
}

fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or_default()
}

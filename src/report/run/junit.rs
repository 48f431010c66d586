//! JUnit XML, which every CI service shows: one test suite per case, one test per experiment and channel.
//!
//! A fail is a `failure` with every number and the command that repeats it. Refused and underpowered experiments are
//! `skipped`. Inconclusive ones are an `error`, a `failure` or `skipped`, as asked for. The time is processor seconds;
//! if an experiment has several channels, the first has all of it. The form is that of the Jenkins schema
//! `junit-10.xsd`.

use std::time::Duration;

use crate::record::baseline::Comparison;
use crate::record::{CaseRecord, Record, Row, Verdict};
use crate::report::junit::{self, ResultKind, Suite, Test, Trouble};
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
pub fn text(record: &Record, inconclusive: Inconclusive) -> String {
    let cases = record.results.cases.iter().map(|case| suite(record, case, inconclusive));
    let suites: Vec<Suite> = cases.chain(record.comparison.as_ref().map(changed)).collect();
    junit::text(&suites, Some(duration(record.timing.seconds)))
}

fn suite(record: &Record, case: &CaseRecord, inconclusive: Inconclusive) -> Suite {
    let results = &record.results;
    let mut whole = Duration::ZERO;
    let tests = case.rows().map(|row| {
        let time = row.experiment.spent.seconds.filter(|_| row.is_first());
        let time = time.map_or(Duration::ZERO, duration);
        whole = whole.saturating_add(time);
        Test {
            name: row.name(),
            class: Some(case.name.clone()),
            time: Some(time),
            trouble: trouble(row, results.seed, inconclusive),
            output: None,
        }
    });
    let tests = tests.collect();
    Suite {
        name: case.name.clone(),
        time: Some(whole),
        properties: vec![
            ("title", case.title.clone()),
            ("seed", results.seed.to_string()),
            ("alpha", number(results.alpha)),
            ("version", results.version.clone()),
            ("schema", results.schema.to_string()),
        ],
        tests,
        output: (!case.notes.is_empty()).then(|| case.notes.join("\n")),
    }
}

/// Returns a suite for the changes since a stored run: a test for each change, or one that passes if nothing changed.
/// Its output is the extent of the comparison, and the experiments that were left out.
fn changed(comparison: &Comparison) -> Suite {
    let all = diff::all(comparison);
    let mut tests = Vec::new();
    if let Some(nothing) = diff::nothing(comparison) {
        let trouble =
            Trouble { kind: ResultKind::Error, word: "nothing", message: nothing, details: None };
        let name = "something was compared".to_owned();
        tests.push(Test { name, trouble: Some(trouble), ..Test::default() });
    } else if !all.iter().any(|change| change.is_worse) {
        tests.push(Test { name: "nothing became worse".to_owned(), ..Test::default() });
    }
    tests.extend(all.iter().filter(|change| change.is_worse).map(|change| {
        let details = format!("{}\nrepeat: {}\n", change.line(), change.command);
        let trouble = Trouble {
            kind: ResultKind::Failure,
            word: "regression",
            message: change.what(),
            details: Some(details),
        };
        Test { name: change.experiment.clone(), trouble: Some(trouble), ..Test::default() }
    }));
    Suite {
        name: format!("baseline {}", comparison.name),
        tests,
        output: Some(diff::remarks(comparison).join("\n")),
        ..Suite::default()
    }
}

fn trouble(row: Row, seed: u64, inconclusive: Inconclusive) -> Option<Trouble> {
    let details = || {
        let details = failures::of_row(row, seed);
        details.iter().map(Failure::details).collect::<Vec<_>>().join("\n")
    };
    trouble_of(row.verdict.unwrap_or(Verdict::Pass), &row.reason(), inconclusive, details)
}

/// Returns the result of a verdict that is no pass, with its reason; a fail or an inconclusive verdict has details.
pub fn trouble_of(
    verdict: Verdict,
    reason: &str,
    inconclusive: Inconclusive,
    details: impl FnOnce() -> String,
) -> Option<Trouble> {
    let kind = match (verdict, inconclusive) {
        (Verdict::Pass, _) => return None,
        (Verdict::Fail, _) | (Verdict::Inconclusive, Inconclusive::Failure) => ResultKind::Failure,
        (Verdict::Inconclusive, Inconclusive::Error) => ResultKind::Error,
        _ => ResultKind::Skipped,
    };
    let is_told = matches!(verdict, Verdict::Fail | Verdict::Inconclusive);
    let (word, message) = (verdict.word(), reason.to_owned());
    Some(Trouble { kind, word, message, details: is_told.then(details) })
}

fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or_default()
}

//! Annotations on GitHub: workflow commands that show failures on the page of the change.
//!
//! `::error title=…,file=…::message` for failures, `::warning` for inconclusive results and for notes on cases. GitHub
//! shows ten of each per step: if there are more, the tenth counts those that are left out.

use crate::record::baseline::Comparison;
use crate::record::{CaseRecord, Record, Verdict};
use crate::report::run::diff;
use crate::report::run::failures::{self, Failure, failing};

/// Number of annotations of a kind that GitHub shows.
const MAX_ANNOTATIONS: usize = 10;

/// Returns the commands, one per line; empty if there is nothing to report.
pub fn text(record: &Record) -> String {
    let of = |verdict| failing(record, verdict).into_iter().map(move |t| of_failure(verdict, &t));
    let errors = of(Verdict::Fail).chain(record.comparison.iter().flat_map(of_changes));
    let lines = at_most("error", errors.collect()).into_iter();
    let notes = record
        .results
        .cases
        .iter()
        .flat_map(|case| case.notes.iter().map(move |note| of_note(case, note)));
    let lines = lines.chain(at_most("warning", of(Verdict::Inconclusive).chain(notes).collect()));
    lines.fold(String::new(), |text, line| text + &line + "\n")
}

/// Returns the commands that GitHub shows of one kind.
fn at_most(command: &str, annotations: Vec<String>) -> Vec<String> {
    let all = annotations.len();
    let shown = if all > MAX_ANNOTATIONS { MAX_ANNOTATIONS - 1 } else { all };
    let mut lines: Vec<String> =
        annotations.into_iter().take(shown).map(|said| format!("::{command} {said}")).collect();
    if shown < all {
        lines.push(format!(
            "::{command} title=trueflight::and {} more; the summary of the job and the reports \
             have them all",
            all - shown
        ));
    }
    lines
}

/// Returns the regressions against a stored run.
fn of_changes(comparison: &Comparison) -> Vec<String> {
    let title = property(&format!("worse than baseline {}", comparison.name));
    let worse = diff::all(comparison).into_iter().filter(|change| change.is_worse);
    let worse = worse.map(|change| {
        let said = format!("{}\nrepeat: {}", change.line(), change.command);
        format!("title={title}::{}", message(&said))
    });
    let nothing = diff::nothing(comparison).map(|nothing| {
        let title = property(&format!("baseline {}", comparison.name));
        format!("title={title}::{}", message(&nothing))
    });
    worse.chain(nothing).collect()
}

fn of_note(case: &CaseRecord, note: &str) -> String {
    format!("{}::{}", properties(case, &format!("note {}", case.name)), message(note))
}

fn of_failure(verdict: Verdict, failure: &Failure) -> String {
    let Failure { row, .. } = *failure;
    let case = row.case;
    let title = format!("{} {}: {}", verdict.word(), case.name, failure.experiment());
    let mut said = format!("{} ({})", failure.reason(), failure.place());
    if let Some(check) = failure.check() {
        said = format!("{check}: {said}");
    }
    if let Some((word, command)) = row.next_command() {
        said = format!("{said}\n{word}: {command}");
    }
    for line in failures::causes(&row) {
        said = format!("{said}\n{line}");
    }
    format!("{}::{}", properties(case, &title), message(&said))
}

/// Returns the title of an annotation and the file of the case.
fn properties(case: &CaseRecord, title: &str) -> String {
    let path = case.path.strip_prefix("./").unwrap_or(&case.path);
    let file = if path.is_empty() { String::new() } else { format!(",file={}", property(path)) };
    format!("title={}{file}", property(title))
}

fn message(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    message(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_github_takes_for_its_own_is_escaped() {
        assert_eq!(message("5 %\r\na: b, c"), "5 %25%0D%0Aa: b, c");
        assert_eq!(property("5 %\r\na: b, c"), "5 %25%0D%0Aa%3A b%2C c");
    }
}

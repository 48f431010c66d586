//! Summary in Markdown, as GitHub shows it on the page of a job: the counts, the cases, failing and inconclusive
//! experiments, each with the command that repeats it.

use std::fmt::Write;

use crate::record::baseline::Comparison;
use crate::record::{CaseRecord, Record, Verdict};
use crate::report::lists::{joined, left_out};
use crate::report::run::diff;
use crate::report::run::failures::{self, Failure, failing};
use crate::report::run::totals;
use numeric::digits::range;

/// Maximum number of rows; more are counted, since a job's summary is limited to a mebibyte.
const MAX_LINES: usize = 50;

/// Returns the record as a page of Markdown.
pub fn text(record: &Record) -> String {
    let mut text = String::from("## Trueflight\n\n");
    let counts = totals::counts(&record.results.cases).into_iter();
    let counts = counts.map(|(verdict, number)| format!("**{number} {}**", verdict.word()));
    let counts = joined(counts, " · ");
    let _ = writeln!(text, "{}\n", if counts.is_empty() { "no experiments" } else { &counts });
    for (verdict, title) in [(Verdict::Fail, "Failing"), (Verdict::Inconclusive, "Inconclusive")] {
        section(&mut text, title, &failing(record, verdict));
    }
    if let Some(comparison) = &record.comparison {
        changed(&mut text, comparison);
    }
    notes(&mut text, &record.results.cases);
    cases(&mut text, &record.results.cases);
    let suspects = totals::suspects(record);
    if !suspects.is_empty() {
        let suspects = suspects.into_iter().take(MAX_LINES).map(totals::suspect);
        let suspects = joined(suspects.map(|suspect| escaped(&suspect)), "; ");
        let _ = writeln!(text, "Look here first (e-BH): {suspects}\n");
    }
    let facts = totals::control(record);
    let _ = writeln!(text, "{}", joined(facts.iter().map(|fact| escaped(fact)), " · "));
    text
}

fn section(text: &mut String, title: &str, failures: &[Failure]) {
    if failures.is_empty() {
        return;
    }
    let _ = writeln!(text, "### {title}\n\n| case | experiment | check | where | why |");
    text.push_str("|---|---|---|---|---|\n");
    for failure in failures.iter().take(MAX_LINES) {
        let cells = [
            failure.row.case.name.clone(),
            failure.experiment(),
            failure.check_name().to_owned(),
            failure.place(),
            failure.reason(),
        ];
        let _ = writeln!(text, "| {} |", cells.map(|cell| escaped(&cell)).join(" | "));
    }
    more(text, failures.len());
    let mut written: Vec<Vec<String>> = Vec::new();
    for failure in failures.iter().take(MAX_LINES) {
        let lines = failures::causes(&failure.row);
        if lines.is_empty() || written.contains(&lines) {
            continue;
        }
        let first =
            format!("{}: {}: {}", failure.row.case.name, failure.row.experiment.label, lines[0]);
        let _ = writeln!(text, "\n{}\n", escaped(&first));
        for line in &lines[1..] {
            let item = line.strip_prefix("- ").unwrap_or(line);
            let _ = writeln!(text, "- {}", escaped(item));
        }
        written.push(lines);
    }
    let mut commands: Vec<(&str, &str)> = Vec::new();
    for failure in failures.iter().take(MAX_LINES) {
        let next = failure.row.next_command();
        commands.extend(next.filter(|next| !commands.contains(next)));
    }
    for word in ["repeat", "decide"] {
        let of_word = commands.iter().filter(|next| next.0 == word).map(|next| next.1);
        let of_word = joined(of_word, "\n");
        if !of_word.is_empty() {
            let _ = writeln!(text, "\nTo {word}:\n\n```sh\n{of_word}\n```");
        }
    }
    text.push('\n');
}

/// Adds the changes since a stored run.
fn changed(text: &mut String, comparison: &Comparison) {
    let _ = writeln!(text, "### Since baseline {}\n", escaped(&comparison.name));
    let all = diff::all(comparison);
    for change in all.iter().take(MAX_LINES) {
        let word = if change.is_worse { "**regression**" } else { "improvement" };
        let _ = writeln!(text, "- {word} {}", escaped(&change.line()));
    }
    more(text, all.len());
    if !all.is_empty() {
        text.push('\n');
    }
    let remarks = diff::remarks(comparison);
    let _ = writeln!(text, "{}\n", joined(remarks.iter().map(|one| escaped(one)), " · "));
}

fn more(text: &mut String, all: usize) {
    if let Some(left) = left_out(all, MAX_LINES) {
        let _ = writeln!(text, "\nand {left} more.");
    }
}

/// Adds the notes on cases.
fn notes(text: &mut String, cases: &[CaseRecord]) {
    let all: Vec<_> =
        cases.iter().flat_map(|case| case.notes.iter().map(move |note| (case, note))).collect();
    if all.is_empty() {
        return;
    }
    text.push_str("### Notes\n\n");
    for (case, note) in all.iter().take(MAX_LINES) {
        let _ = writeln!(text, "- {}: {}", escaped(&case.name), escaped(note));
    }
    more(text, all.len());
    text.push('\n');
}

fn cases(text: &mut String, cases: &[CaseRecord]) {
    if cases.is_empty() {
        return;
    }
    text.push_str("### Cases\n\n| case | verdicts | draws | smallest visible bias |\n");
    text.push_str("|---|---|--:|--:|\n");
    for case in cases {
        let bias = case.visible_bias.map(range).unwrap_or_default();
        let cells = [case.name.clone(), totals::words(case), totals::draws(case), bias];
        let _ = writeln!(text, "| {} |", cells.map(|cell| escaped(&cell)).join(" | "));
    }
    text.push('\n');
}

/// Returns the text on one line, without characters that Markdown would take for markup.
fn escaped(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\r' => plain.push(' '),
            '|' | '*' | '_' | '`' | '[' | ']' | '<' | '>' | '\\' | '~' | '#' | '&' => {
                plain.extend(['\\', c]);
            }
            _ => plain.push(c),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stay_words() {
        assert_eq!(escaped("a|b\n<c> *d*"), "a\\|b \\<c\\> \\*d\\*");
    }
}

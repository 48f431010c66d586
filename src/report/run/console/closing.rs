//! Summary below the cases: suspects, failures with the commands that repeat them, the counts, and the run's error
//! control.

use super::views::{NEEDS, SETUP};
use super::{TableView, views};
use crate::record::{Best, CaseRecord, Record, Row, Verdict};
use crate::report::layout::{Paint, Pen, wrapped};
use crate::report::lists::{joined, left_out};
use crate::report::run::diff;
use crate::report::run::failures::{self, failing};
use crate::report::run::fields;
use crate::report::run::totals;
use estimators::Knowledge;
use numeric::digits::{counted, short};
use std::fmt::Write;

/// Maximum number of suspects that are listed; more are counted.
const SUSPECTS: usize = 5;

/// Adds the closing summary to a text.
pub fn write(text: &mut String, pen: Pen, record: &Record, view: TableView) {
    if view == TableView::Run {
        suspects(text, pen, record);
        failures(text, pen, record);
    }
    if view == TableView::Plan {
        foreseen(text, pen, &record.results.cases);
    }
    counts(text, pen, record, view);
    let mut facts = totals::control(record);
    if view == TableView::Run {
        let (seconds, threads) = (short(record.timing.seconds, 3), record.timing.threads);
        facts.push(format!("{seconds} s, threads: {threads}"));
    }
    pen.say(text, Paint::Dim, &facts.join(" · "));
    if let Some(comparison) = &record.comparison {
        diff::changes(comparison).write(text, pen);
    }
}

fn suspects(text: &mut String, pen: Pen, record: &Record) {
    let triage = totals::suspects(record);
    if triage.is_empty() {
        return;
    }
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, "look here first"));
    for suspect in triage.iter().take(SUSPECTS) {
        pen.note(text, &totals::suspect(suspect), ("", Paint::Plain));
    }
    if let Some(left) = left_out(triage.len(), SUSPECTS) {
        let _ = writeln!(text, "  and {left} more");
    }
    text.push('\n');
}

/// Returns a line below a failure, wrapped.
fn indented(line: &str, pen: Pen) -> Vec<String> {
    let parts = wrapped(line, pen.width.saturating_sub(6)).into_iter().enumerate();
    parts.map(|(i, part)| format!("{}{part}", if i == 0 { "    " } else { "      " })).collect()
}

/// Adds one line per failing finding, and the command that repeats it, on one line so that it can be copied.
fn failures(text: &mut String, pen: Pen, record: &Record) {
    let failures = failing(record, Verdict::Fail);
    let mut lines: Vec<Vec<String>> = Vec::new();
    for (i, failure) in failures.iter().enumerate() {
        let word = Verdict::Fail.word();
        pen.note(text, &format!("{word} {}", failure.line()), (word, Paint::Red));
        if let Some((word, command)) = failure.row.next_command() {
            let _ = writeln!(text, "    {word}: {command}");
        }
        // Causes are listed once for all findings of a row, and once for all similar rows of an estimator.
        let likely = failures::causes(&failure.row);
        let next = failures.get(i + 1);
        let is_last = next.is_none_or(|next| {
            next.row.name() != failure.row.name() || next.row.case.name != failure.row.case.name
        });
        if is_last && !likely.is_empty() && !lines.contains(&likely) {
            for part in likely.iter().flat_map(|line| indented(line, pen)) {
                let _ = writeln!(text, "{part}");
            }
            lines.push(likely);
        }
    }
    if !failures.is_empty() {
        text.push('\n');
    }
}

/// Adds the rows that the planned draws leave inconclusive, case by case, with the command that decides them.
fn foreseen(text: &mut String, pen: Pen, cases: &[CaseRecord]) {
    let rows = |case: &CaseRecord, verdict| case.rows().filter(|row| row.foresees(verdict)).count();
    let open = cases.iter().filter(|case| rows(case, Verdict::Inconclusive) > 0);
    for case in open {
        let word = Verdict::Inconclusive.word();
        let (open, all) = (rows(case, Verdict::Inconclusive), case.rows().count());
        let draws = "the planned draws are too few for a pass";
        pen.note(
            text,
            &format!("{word} {}: {open} of {all} rows: {draws}", case.name),
            (word, Paint::Yellow),
        );
        if let Some(row) = case.rows().find(|row| !row.decide.is_empty()) {
            let _ = writeln!(text, "    decide: {}", row.decide);
        }
    }
    let weak: usize = cases.iter().map(|case| rows(case, Verdict::Underpowered)).sum();
    if weak > 0 {
        let word = Verdict::Underpowered.word();
        let note = format!(
            "{word} {}: a check other than the mean, or one that the case allows, has too few draws for a \
             pass; the column `needed` says how many it takes",
            counted(weak as u64, "row")
        );
        pen.note(text, &note, (word, Paint::Dim));
    }
}

fn counts(text: &mut String, pen: Pen, record: &Record, view: TableView) {
    let cases = &record.results.cases;
    let rows = || cases.iter().flat_map(CaseRecord::rows);
    let mut counts: Vec<String> = totals::counts(cases)
        .into_iter()
        .map(|(verdict, number)| {
            pen.paint(views::paint(verdict), &format!("{number} {}", verdict.word()))
        })
        .collect();
    let open = rows().filter(|row| row.verdict.is_none()).count();
    if open > 0 {
        let skipped = rows().filter(|row| views::is_skipped(row, view)).count();
        let word = match view {
            TableView::Run => "undecided",
            TableView::Predict | TableView::Moments => "predicted",
            TableView::Plan => "planned",
        };
        if open > skipped {
            counts.push(format!("{} {word}", open - skipped));
        }
        if skipped > 0 {
            counts.push(pen.paint(Paint::Dim, &format!("{skipped} skipped")));
        }
    }
    let all = if counts.is_empty() { "no experiments".to_owned() } else { counts.join(" · ") };
    let _ = writeln!(text, "{all}");
}

/// Adds the notes, each once; `is_shown` returns whether the table has a column.
pub fn costs(text: &mut String, pen: Pen, rows: &[Row], is_shown: &dyn Fn(&str) -> bool) {
    let mut notes: Vec<String> = Vec::new();
    let mut say = |row: &Row, channel: &str, what: String| {
        let names = [row.experiment.label.as_str(), &row.experiment.id.control, channel];
        let note = format!("note {}: {what}", joined(names, ", "));
        if !notes.contains(&note) {
            notes.push(note);
        }
    };
    for row in rows {
        if let Some(best) = best(row) {
            say(row, &row.channel, best);
        }
        let setup = row.experiment.setup_lookups.unwrap_or(0);
        if setup > 0 && !is_shown(SETUP) {
            say(row, "", format!("{setup} setup lookups"));
        }
        if !row.experiment.needs.is_empty() && !is_shown(NEEDS) {
            say(row, "", format!("needs {}", Knowledge::list(&row.experiment.needs)));
        }
    }
    for note in notes {
        pen.note(text, &note, ("note", Paint::Plain));
    }
}

/// Returns words for the best σ̂ of a row; `None` if it was not searched.
fn best(row: &Row) -> Option<String> {
    let finding = row.best.as_ref()?;
    let (Best { sampling, fom, limit, .. }, kind) = (finding, fields::kind(finding));
    let fom = fom.map_or("∞".to_owned(), |fom| short(fom, 4));
    let best = format!("best σ\u{302} {}, best FoM {fom}", short(*sampling, 4));
    Some(match *limit {
        Some(limit) => {
            let limit = short(limit, 4);
            format!("{best} is {kind}; the limit is {limit}, FoM rises to it with σ\u{302}")
        }
        None => format!("{best} ({kind})"),
    })
}

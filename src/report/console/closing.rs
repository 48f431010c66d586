//! What stands below the cases: what each could have seen, where to look, what fails and how to
//! repeat it, the counts, and the run's error control.

use std::fmt::Write;

use super::layout::{Grid, Paint, Pen};
use super::{View, views};
use crate::baseline::Comparison;
use crate::catalogue::digits::{fixed, range, short};
use crate::harness::record::{CaseRecord, Record, Verdict};
use crate::report::diff;
use crate::report::failures::failing;
use crate::report::totals;

/// Beyond so many, suspects are only counted.
const SUSPECTS: usize = 5;

/// Adds the closing summary to a text.
pub fn write(text: &mut String, pen: Pen, record: &Record, view: View) {
    if view == View::Run {
        visible(text, pen, record);
        suspects(text, pen, record);
        failures(text, pen, record);
    }
    counts(text, pen, record, view);
    let mut facts = totals::control(record);
    if view == View::Run {
        let (seconds, threads) = (short(record.timing.seconds, 3), record.timing.threads);
        facts.push(format!("{seconds} s, threads: {threads}"));
    }
    pen.say(text, Paint::Dim, &facts.join(" · "));
    if let Some(comparison) = &record.comparison {
        changed(text, pen, comparison);
    }
}

/// What changed since a stored run: only what did.
fn changed(text: &mut String, pen: Pen, comparison: &Comparison) {
    text.push('\n');
    for change in diff::all(comparison) {
        let (word, paint) = if change.is_worse {
            ("REGRESSION", Paint::Red)
        } else {
            ("improvement", Paint::Green)
        };
        pen.note(text, &format!("{word} {}", change.line()), (word, paint));
        if change.is_worse {
            let _ = writeln!(text, "    repeat: {}", change.command);
        }
    }
    for remark in diff::remarks(comparison) {
        pen.say(text, Paint::Dim, &remark);
    }
}

/// For each case, the smallest bias that it could have seen, and how soon it was decided.
fn visible(text: &mut String, pen: Pen, record: &Record) {
    let cases = record.results.cases.iter().filter(|case| case.visible_bias.is_some());
    let cases: Vec<&CaseRecord> = cases.collect();
    if cases.is_empty() {
        return;
    }
    let mut grid = Grid::of(
        &cases,
        &[
            ("case", false, 0, |case| case.name.clone()),
            ("visible bias", true, 0, |case| case.visible_bias.map(range).unwrap_or_default()),
            ("time to verdict", true, 0, |case| {
                case.pace.map(|pace| fixed(pace, 3)).unwrap_or_default()
            }),
        ],
    );
    grid.fit(pen.width);
    let _ = writeln!(text, "{}\n", grid.render(pen).trim_end());
}

fn suspects(text: &mut String, pen: Pen, record: &Record) {
    let triage = &record.results.gate.triage;
    if triage.is_empty() {
        return;
    }
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, "look here first"));
    for suspect in triage.iter().take(SUSPECTS) {
        pen.note(text, &totals::suspect(suspect), ("", Paint::Plain));
    }
    if let Some(left) = triage.len().checked_sub(SUSPECTS).filter(|&left| left > 0) {
        let _ = writeln!(text, "  and {left} more");
    }
    text.push('\n');
}

/// One line per failing finding, and the command that repeats it, whole so that it can be copied.
fn failures(text: &mut String, pen: Pen, record: &Record) {
    let failures = failing(record, Verdict::Fail);
    for failure in &failures {
        let word = Verdict::Fail.word();
        pen.note(text, &format!("{word} {}", failure.line()), (word, Paint::Red));
        if !failure.row.command.is_empty() {
            let _ = writeln!(text, "    repeat: {}", failure.row.command);
        }
    }
    if !failures.is_empty() {
        text.push('\n');
    }
}

fn counts(text: &mut String, pen: Pen, record: &Record, view: View) {
    let cases = &record.results.cases;
    let rows = || cases.iter().flat_map(|case| &case.rows);
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
            View::Run => "undecided",
            View::Predict | View::Moments => "predicted",
            View::Plan => "planned",
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

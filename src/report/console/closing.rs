//! What stands below the cases: what each could have seen, where to look, what fails and how to
//! repeat it, the counts, and the run's error control.

use std::fmt::Write;

use super::layout::{self, Column, Field, Grid, Paint, Pen, wrapped};
use super::{View, views};
use crate::harness::baseline::Comparison;
use crate::harness::record::{CaseRecord, Record, Verdict};
use crate::report::changes;
use crate::report::number::{fixed, range, short};
use crate::report::totals;
use crate::report::troubles::troubles;

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
    for line in wrapped(&facts.join(" · "), pen.width) {
        let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &line));
    }
    if let Some(comparison) = &record.comparison {
        changed(text, pen, comparison);
    }
}

/// What changed since a stored run: only what did.
fn changed(text: &mut String, pen: Pen, comparison: &Comparison) {
    text.push('\n');
    for change in changes::all(comparison) {
        let (word, paint) = if change.is_worse {
            ("REGRESSION", Paint::Red)
        } else {
            ("improvement", Paint::Green)
        };
        indented(text, pen, &format!("{word} {}", change.line()), Some((word, paint)));
        if change.is_worse {
            let _ = writeln!(text, "    repeat: {}", change.command);
        }
    }
    for remark in changes::remarks(comparison) {
        for line in wrapped(&remark, pen.width) {
            let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &line));
        }
    }
}

/// For each case, the smallest bias that it could have seen, and how soon it was decided.
fn visible(text: &mut String, pen: Pen, record: &Record) {
    let cases = || record.results.cases.iter().filter(|case| case.visible_bias.is_some());
    if cases().next().is_none() {
        return;
    }
    let column = |head, right, field: fn(&CaseRecord) -> String| Column {
        head,
        right,
        rank: 0,
        fields: cases().map(|case| Field::plain(field(case))).collect(),
    };
    let bias = |case: &CaseRecord| case.visible_bias.map(range).unwrap_or_default();
    let pace = |case: &CaseRecord| case.pace.map(|pace| fixed(pace, 3)).unwrap_or_default();
    let columns = vec![
        column("case", false, |case| case.name.clone()),
        column("visible bias", true, bias),
        column("time to verdict", true, pace),
    ];
    let mut grid = Grid { columns };
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
        indented(text, pen, &totals::suspect(suspect), None);
    }
    if let Some(left) = triage.len().checked_sub(SUSPECTS).filter(|&left| left > 0) {
        let _ = writeln!(text, "  and {left} more");
    }
    text.push('\n');
}

/// One line per failing finding, and the command that repeats it, whole so that it can be copied.
fn failures(text: &mut String, pen: Pen, record: &Record) {
    let troubles = troubles(record, Verdict::Fail);
    for trouble in &troubles {
        let word = Verdict::Fail.word();
        indented(text, pen, &format!("{word} {}", trouble.line()), Some((word, Paint::Red)));
        if !trouble.row.command.is_empty() {
            let _ = writeln!(text, "    repeat: {}", trouble.row.command);
        }
    }
    if !troubles.is_empty() {
        text.push('\n');
    }
}

/// A text wrapped and moved in, with its first word painted.
fn indented(text: &mut String, pen: Pen, what: &str, first: Option<(&str, Paint)>) {
    for (i, line) in wrapped(what, pen.width - 4).into_iter().enumerate() {
        let line = match first.filter(|_| i == 0) {
            Some((word, paint)) => match line.strip_prefix(word) {
                Some(rest) => format!("{}{rest}", pen.paint(paint, word)),
                None => line,
            },
            None => line,
        };
        let _ = writeln!(text, "{}{line}", if i == 0 { "  " } else { "    " });
    }
}

fn counts(text: &mut String, pen: layout::Pen, record: &Record, view: View) {
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

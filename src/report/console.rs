//! The table on the screen: one block per case, then what it all comes to.
//!
//! A block is as wide as the screen and no wider: columns leave in the order of their rank, long
//! names lose their middle, and reasons without a place in the table follow below it. What all
//! rows of a case share stands once, over the table.

pub mod baseline;
pub mod judgement;
pub mod layout;
pub mod views;

use std::fmt::Write;

use crate::harness::record::{CaseRecord, Record, Row, Verdict};
use crate::report::number::{count, short};
use layout::{Field, Grid, Paint, end_elided, wrapped};

/// What the table is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// What was drawn and decided.
    Run,
    /// What theory says.
    Predict,
    /// What would be drawn.
    Plan,
}

/// The narrowest column of reasons that is worth having.
const NARROWEST: usize = 20;
/// From this width on, reasons may stand in the table.
const WIDE: usize = 120;

/// The table of a record, `width` columns wide, with ANSI colours if asked for.
#[must_use]
pub fn table(record: &Record, view: View, width: usize, colour: bool) -> String {
    let pen = layout::Pen { width: width.max(40), colour };
    let mut text = String::new();
    for case in &record.results.cases {
        block(&mut text, pen, case, view);
        text.push('\n');
    }
    closing(&mut text, pen, record, view);
    text
}

fn block(text: &mut String, pen: layout::Pen, case: &CaseRecord, view: View) {
    let name = end_elided(&case.name, pen.width);
    let room = pen.width.saturating_sub(layout::width(&name) + 2);
    let title = if room > 8 { end_elided(&case.title, room) } else { String::new() };
    let _ = writeln!(text, "{}  {title}", pen.paint(Paint::Bold, &name));
    let facts = facts(case, view).join(" · ");
    for line in wrapped(&facts, pen.width) {
        let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &line));
    }
    let mut grid = Grid { columns: views::columns(case, view) };
    grid.fit(pen.width);
    let rest = pen.width.saturating_sub(grid.width() + 2);
    let longest = case.rows.iter().map(|row| layout::width(&row.reason)).max().unwrap_or(0);
    let beside = pen.width >= WIDE && rest >= NARROWEST && longest > 0;
    if beside {
        let cells = case.rows.iter().map(|row| Field::plain(end_elided(&row.reason, rest)));
        grid.push("reason", cells.collect());
    }
    text.push_str(&grid.render(pen));
    let room = if beside { rest } else { 0 };
    footnotes(text, pen, case, view, room);
}

/// What all rows share, and what the case is about.
fn facts(case: &CaseRecord, view: View) -> Vec<String> {
    let mut facts = vec![case.problem.clone(), case.medium.clone()];
    if let Some(truth) = views::shared(case, |row| row.truth) {
        facts.push(format!("truth {}", short(truth, 6)));
    }
    if let Some(draws) = views::shared(case, |row| row.draws).filter(|_| view != View::Predict) {
        let word = if draws == 1 { "draw" } else { "draws" };
        facts.push(format!("{} {word} each", count(draws)));
    }
    facts.retain(|fact| !fact.is_empty());
    facts
}

/// The reasons that have no place in the table, each once, with the rows it is about.
fn footnotes(text: &mut String, pen: layout::Pen, case: &CaseRecord, view: View, room: usize) {
    let mut notes: Vec<Vec<&Row>> = Vec::new();
    for row in case.rows.iter().filter(|row| layout::width(&row.reason) > room) {
        let same = |rows: &&mut Vec<&Row>| {
            rows[0].reason == row.reason && rows[0].estimator == row.estimator
        };
        match notes.iter_mut().find(same) {
            Some(rows) => rows.push(row),
            None => notes.push(vec![row]),
        }
    }
    for rows in notes {
        let (row, status) = (rows[0], views::status(rows[0], view).text);
        let places = views::places(case, &rows);
        let at = if places.is_empty() { places } else { format!(" ({places})") };
        let word = if status.is_empty() { "note" } else { &status };
        let note = format!("{word} {}{at}: {}", row.estimator, row.reason);
        for (i, line) in wrapped(&note, pen.width - 4).into_iter().enumerate() {
            // The word is coloured after the text is wrapped, for colours have no width.
            let line = match line.strip_prefix(word).filter(|_| i == 0) {
                Some(rest) => format!("{}{rest}", pen.paint(views::status(row, view).paint, word)),
                None => line,
            };
            let _ = writeln!(text, "{}{line}", if i == 0 { "  " } else { "    " });
        }
    }
}

fn closing(text: &mut String, pen: layout::Pen, record: &Record, view: View) {
    let results = &record.results;
    let rows = || results.cases.iter().flat_map(|case| &case.rows);
    let mut counts = Vec::new();
    for verdict in [
        Verdict::Pass,
        Verdict::Fail,
        Verdict::Inconclusive,
        Verdict::Underpowered,
        Verdict::Refused,
    ] {
        let number = rows().filter(|row| row.verdict == Some(verdict)).count();
        if number > 0 {
            let words = format!("{number} {}", verdict.word());
            counts.push(pen.paint(views::paint(verdict), &words));
        }
    }
    let open = rows().filter(|row| row.verdict.is_none()).count();
    if open > 0 {
        let skipped = rows().filter(|row| views::is_skipped(row, view)).count();
        let word = match view {
            View::Run => "undecided",
            View::Predict => "predicted",
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
    let mut facts = Vec::new();
    let gate = &results.gate;
    if gate.scalars + gate.laws > 0 {
        let (scalars, laws) = (gate.scalars, gate.laws);
        let alpha = short(results.alpha, 3);
        facts.push(format!("{scalars} scalars and {laws} laws share α = {alpha}"));
    }
    facts.push(format!("seed {}", results.seed));
    if view == View::Run {
        let (seconds, threads) = (short(record.timing.seconds, 3), record.timing.threads);
        facts.push(format!("{seconds} s, threads: {threads}"));
    }
    if results.cut_by_time {
        facts.push("cut short by the time limit: other machines will differ".to_owned());
    }
    for line in wrapped(&facts.join(" · "), pen.width) {
        let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &line));
    }
}

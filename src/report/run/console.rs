//! Table on the screen: one block per case, then a summary.
//!
//! A block is at most as wide as the screen: columns are dropped in the order of their rank, long names lose their
//! middle, and reasons without a place in the table follow below it. Facts that all rows of a case share stand once,
//! above the table.

mod closing;
pub mod views;

use std::fmt::Write;

use crate::plan::{Options, Plan};
use crate::record::{CaseRecord, Digits, Record, Row, Verdict};
use crate::report::layout::{self, LayoutField, Paint, TableLayout, end_elided};
use crate::report::lists::grouped;
use crate::report::run::summary_csv::SummaryRow;
use crate::report::run::totals;
use numeric::digits::{count, counted, fixed, range, short};

/// Subject of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableView {
    /// Draws and verdicts.
    Run,
    /// Predictions.
    Predict,
    /// Predicted moments and costs in full.
    Moments,
    /// Planned draws.
    Plan,
}

impl TableView {
    /// Returns whether it shows predictions only.
    pub fn is_theory(self) -> bool {
        matches!(self, Self::Predict | Self::Moments)
    }
}

/// Smallest useful width of a column of reasons.
const MIN_WIDTH: usize = 20;
/// Width of the screen from which on reasons may stand in the table.
const WIDE: usize = 120;

/// Returns the table of a record.
pub fn table(record: &Record, view: TableView, pen: layout::Pen) -> String {
    let mut text = String::new();
    let mut marks = false;
    for case in &record.results.cases {
        marks |= block(&mut text, pen, case, (record.results.seed, view));
        text.push('\n');
    }
    legend(&mut text, pen, marks);
    closing::write(&mut text, pen, record, view);
    text
}

/// Returns the case of a plan, or the number of its cases.
pub fn subjects(plan: &Plan) -> String {
    match &plan.cases[..] {
        [one] => one.case.name.clone(),
        cases => counted(cases.len() as u64, "case"),
    }
}

/// Returns the first line of predictions.
pub fn prediction_heading(plan: &Plan) -> String {
    let experiments = counted(plan.experiments().count() as u64, "experiment");
    format!("{}: theory of {experiments}, nothing is drawn\n", subjects(plan))
}

/// Returns the first line of a run: what is drawn, and at which level.
pub fn opening(plan: &Plan) -> String {
    let Options { seed, alpha, .. } = plan.options;
    let cases = subjects(plan);
    let drawn = plan.experiments().filter(|(_, planned)| planned.outcome.is_ok());
    let [maximum, horizon] = drawn.fold([0; 2], |[maximum, horizon], (_, planned)| {
        [maximum.max(planned.draws), horizon.max(planned.horizon)]
    });
    let experiments = counted(plan.experiments().count() as u64, "experiment");
    format!(
        "{cases}: {experiments}, {} each planned and at most {}, seed {seed}, α = {}\n",
        counted(maximum, "draw"),
        count(horizon),
        short(alpha, 3)
    )
}

/// Returns the last words of a run: its verdict, and what that means.
pub fn meaning(record: &Record, pen: layout::Pen) -> String {
    let verdict = totals::verdict(record);
    let paint = match verdict.class {
        "pass" => Paint::Green,
        "fail" => Paint::Red,
        _ => Paint::Yellow,
    };
    let mut text = String::new();
    pen.say(&mut text, paint, &verdict.words());
    pen.say(&mut text, Paint::Plain, &verdict.meaning(record));
    text
}

/// Returns the short table of a run: one line per case, and below it the rows that do not pass.
pub fn brief(record: &Record, pen: layout::Pen) -> String {
    let (mut text, mut marks) = (String::new(), false);
    for case in &record.results.cases {
        let quiet = |row: &Row| !matches!(row.verdict, Some(Verdict::Pass) | None);
        let rows: Vec<Row> = case.rows().filter(quiet).collect();
        let line = format!("{}  {}", case.name, outcome(case).join(" · "));
        if rows.is_empty() {
            let _ = writeln!(text, "{}", end_elided(&line, pen.width));
            notes(&mut text, pen, case);
            continue;
        }
        let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &end_elided(&line, pen.width)));
        notes(&mut text, pen, case);
        let (seed, labels) = (record.results.seed, Digits::of(case));
        marks |= grid(&mut text, pen, &CaseRows { case, rows, labels, seed }, TableView::Run);
    }
    text.push('\n');
    legend(&mut text, pen, marks);
    closing::write(&mut text, pen, record, TableView::Run);
    text
}

/// Rows of a case that are shown.
struct CaseRows<'a> {
    case: &'a CaseRecord,
    rows: Vec<Row<'a>>,
    labels: Digits,
    seed: u64,
}

/// Adds the meaning of parentheses, if there are any.
fn legend(text: &mut String, pen: layout::Pen, marks: bool) {
    if marks {
        pen.say(text, Paint::Dim, totals::NOT_NORMAL);
    }
}

/// Writes a case; returns whether a z is marked.
fn block(
    text: &mut String,
    pen: layout::Pen,
    case: &CaseRecord,
    (seed, view): (u64, TableView),
) -> bool {
    pen.heading(text, &case.name, &case.title);
    let shown = CaseRows { case, rows: case.rows().collect(), labels: Digits::of(case), seed };
    pen.say(text, Paint::Dim, &facts(&shown, view).join(" · "));
    if view == TableView::Plan {
        case.facts.iter().for_each(|fact| pen.note(text, fact, ("", Paint::Plain)));
    }
    notes(text, pen, case);
    grid(text, pen, &shown, view)
}

/// Writes the rows with their reasons; returns whether a z is marked.
fn grid(text: &mut String, pen: layout::Pen, block: &CaseRows, view: TableView) -> bool {
    let CaseRows { case, rows, labels, seed } = block;
    let lines: Vec<SummaryRow> = rows.iter().map(|&row| SummaryRow { row, seed: *seed }).collect();
    let (names, rest) = (views::names(case, rows, *labels), views::columns(&lines, view));
    if view == TableView::Moments {
        // All columns were asked for: those that do not fit stand in further tables below.
        for grid in layout::blocks(names, rest, pen.width) {
            text.push_str(&grid.render(pen));
        }
        closing::costs(text, pen, rows, &|_| true);
        footnotes(text, pen, block, view, 0);
        return false;
    }
    let mut grid = TableLayout { columns: names.into_iter().chain(rest).collect() };
    grid.fit(pen.width);
    let rest = pen.width.saturating_sub(grid.width() + 2);
    let longest = rows.iter().map(|row| layout::width(&row.reason())).max().unwrap_or(0);
    let beside = pen.width >= WIDE && rest >= MIN_WIDTH && longest > 0;
    if beside {
        let cells = rows.iter().map(|row| LayoutField::plain(end_elided(&row.reason(), rest)));
        grid.push("reason", cells.collect());
    }
    text.push_str(&grid.render(pen));
    let room = if beside { rest } else { 0 };
    closing::costs(text, pen, rows, &|head| grid.columns.iter().any(|column| column.head == head));
    footnotes(text, pen, block, view, room);
    let scores = grid.columns.iter().filter(|column| views::SCORES.contains(&column.head));
    scores.flat_map(|column| &column.fields).any(|field| field.text.starts_with('('))
}

/// Adds the notes on a case.
fn notes(text: &mut String, pen: layout::Pen, case: &CaseRecord) {
    for note in &case.notes {
        pen.note(text, &format!("note {note}"), ("note", Paint::Yellow));
    }
}

/// Returns the facts that all rows share, and the subject of the case.
fn facts(block: &CaseRows, view: TableView) -> Vec<String> {
    let CaseRows { case, rows, .. } = block;
    let mut facts = vec![case.problem.clone(), case.medium.clone()];
    if let Some(truth) = views::shared(rows, |row| row.truth) {
        facts.push(format!("truth {}", short(truth, 6)));
    }
    if let Some(unit) = views::shared(rows, |row| row.log_unit) {
        facts.push(format!("in units of exp(−{})", short(unit, 6)));
    }
    if let Some(draws) =
        views::shared(rows, |row| row.experiment.draws).filter(|_| !view.is_theory())
    {
        let what = if view == TableView::Run { "statistics of " } else { "" };
        facts.push(format!("{what}{} each", counted(draws, "draw")));
    }
    if let Some(drawn) =
        views::shared(rows, |row| row.experiment.drawn).filter(|_| view == TableView::Run)
    {
        facts.push(format!("{} drawn each", count(drawn)));
    }
    if rows.iter().any(|row| row.experiment.setup_lookups.is_some_and(|lookups| lookups > 0)) {
        let shared = counted(case.draws_per_ray, "draw");
        facts.push(format!("FoM with setup lookups shared by {shared}"));
    }
    if view == TableView::Run {
        facts.extend(reach(case));
    }
    facts.retain(|fact| !fact.is_empty());
    facts
}

/// Returns verdicts, draws and reach of a case.
fn outcome(case: &CaseRecord) -> Vec<String> {
    let mut parts = vec![totals::words(case), format!("{} draws", totals::draws(case))];
    parts.extend(reach(case));
    parts
}

/// Returns the bias of a mean that the case could have detected, and its pace of decisions.
fn reach(case: &CaseRecord) -> Vec<String> {
    let bias = case.visible_bias.map(|bias| format!("visible bias {}", range(bias)));
    let pace = case.pace.filter(|_| bias.is_some());
    let pace = pace.map(|pace| format!("time to verdict {}", fixed(pace, 3)));
    bias.into_iter().chain(pace).collect()
}

/// Adds the reasons without a place in the table, each once, with its rows.
fn footnotes(text: &mut String, pen: layout::Pen, block: &CaseRows, view: TableView, room: usize) {
    let CaseRows { case, rows, labels, .. } = block;
    // Failures follow below the tables.
    let is_told = |row: &&Row| view == TableView::Run && row.verdict == Some(Verdict::Fail);
    let without = |row: &&Row| layout::width(&row.reason()) > room && !is_told(row);
    let notes = grouped(rows.iter().filter(without), |one, other| {
        one.reason() == other.reason() && one.experiment.label == other.experiment.label
    });
    for row in rows.iter().filter(|row| row.experiment.same_as.is_some()) {
        let positions = views::positions(case, &[row], *labels);
        let at = if positions.is_empty() { positions } else { format!(" ({positions})") };
        let (this, other) = (&row.experiment.label, row.experiment.same_as());
        let _ = writeln!(text, "  note {this}{at} is {other} by definition: drawn once for both");
    }
    let mut commands: Vec<(&str, &str)> = Vec::new();
    for row in rows.iter().filter(|row| row.verdict == Some(Verdict::Inconclusive)) {
        let next = row.next_command().map(|(_, command)| (row.experiment.label.as_str(), command));
        commands.extend(next.filter(|next| !commands.contains(next)));
    }
    for rows in notes {
        let (row, status) = (rows[0], views::status(rows[0], view).text);
        let positions = views::positions(case, &rows, *labels);
        let at = if positions.is_empty() { positions } else { format!(" ({positions})") };
        let word = if status.is_empty() { "note" } else { &status };
        let note = format!("{word} {}{at}: {}", row.experiment.label, row.reason());
        pen.note(text, &note, (word, views::status(row, view).paint));
    }
    // Commands are not wrapped, so that they can be copied.
    for (estimator, command) in commands {
        let _ = writeln!(text, "  to decide {estimator}: {command}");
    }
}

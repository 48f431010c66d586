//! Map of verdicts: a block for each case, a line for each estimator, a cell for each experiment with σ̂ or the swept
//! quantity from left to right. With many cases each is one line.

use crate::report::html::template::{Markup, html};

use crate::record::{CaseRecord, Digits, ExperimentRecord, Record, Row, Verdict};
use crate::report::html::words;
use crate::report::lists::grouped;

/// Number of lines above which the map is dense.
const CROWD: usize = 30;

/// Line of the map: experiments of one estimator of a case.
struct MapLine<'a> {
    label: String,
    cells: Vec<&'a ExperimentRecord>,
}

/// Map of a run.
pub struct Map {
    /// True if each case is one line.
    pub is_dense: bool,
    /// Its content.
    pub shown: Markup,
}

/// Returns the map of a run.
pub fn map(record: &Record) -> Map {
    let cases = &record.results.cases;
    let all: Vec<Vec<MapLine>> = cases.iter().map(lines).collect();
    let is_dense = all.iter().map(Vec::len).sum::<usize>() > CROWD;
    let mut last = "";
    // Cases of a folder stand together.
    let placed = grouped(cases.iter().zip(&all).enumerate(), |one, other| {
        is_dense && folder_and_name(one.1.0).0 == folder_and_name(other.1.0).0
    });
    let blocks = placed.into_iter().flatten().map(|(place, (case, lines))| {
        let (folder, name) = folder_and_name(case);
        let is_new = is_dense && std::mem::replace(&mut last, folder) != folder;
        html! {
            @if is_new { p.folder { (folder) } }
            div.block {
                a.of href={ "#case-" (place) } title=[(!case.title.is_empty()).then_some(&case.title)] {
                    (if is_dense { name } else { &case.name })
                }
                div.lines {
                    @for line in lines { div.line {
                        @if !is_dense { span.label { (line.label) } }
                        span.cells { @for one in &line.cells { (cell(case, one)) } }
                    } }
                    @if !is_dense { (axis(case)) }
                }
            }
        }
    });
    let blocks: Vec<Markup> = blocks.collect();
    Map { is_dense, shown: html! { div.map.dense[is_dense] { @for block in blocks { (block) } } } }
}

fn folder_and_name(case: &CaseRecord) -> (&str, &str) {
    case.name.rsplit_once('/').unwrap_or(("", &case.name))
}

/// Returns the experiments of a case by estimator, each in the order of the sweep.
fn lines(case: &CaseRecord) -> Vec<MapLine<'_>> {
    let listed = grouped(&case.experiments, |one, other| one.listed == other.listed);
    let lines = listed.into_iter().map(|cells| {
        let control = &cells[0].id.control;
        let comma = if control.is_empty() { "" } else { ", control " };
        MapLine { label: format!("{}{comma}{control}", cells[0].label), cells }
    });
    lines.collect()
}

/// Returns an experiment: a link to its row of the table, that of the worst channel.
fn cell(case: &CaseRecord, experiment: &ExperimentRecord) -> Markup {
    let rows = experiment.channels.iter().enumerate();
    let rows = rows.map(|(number, values)| Row { case, experiment, number, values });
    let Some(worst) = rows.min_by_key(|row| words::severity(row.verdict)) else { return html! {} };
    let word = words::word(worst.verdict);
    let mark = if worst.verdict == Some(Verdict::Pass) { "" } else { words::mark(worst.verdict) };
    html! {
        a class={ "cell " (word) } href={ "#" (words::anchor(&worst)) } title={ (worst.name()) ": " (word) } { (mark) }
    }
}

/// Returns the ends of the swept quantity, below the cells.
fn axis(case: &CaseRecord) -> Markup {
    let digits = Digits::of(case);
    let swept = || case.experiments.iter().filter_map(ExperimentRecord::swept);
    let ends = [swept().reduce(f64::min), swept().reduce(f64::max)];
    html! {
        @if let (Some(sweep), [Some(low), Some(high)]) = (&case.sweep, ends) {
            div.line.axis {
                span.label {}
                span.cells { span { (digits.text(low)) } span { (sweep.axis) } span { (digits.text(high)) } }
            }
        }
    }
}

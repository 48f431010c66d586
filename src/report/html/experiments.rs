//! The table of all experiments, a row for each channel. Rows are hidden and moved by the page's script.

use maud::{Markup, html};

use super::filters::{self, Choice};
use super::plots::Plot;
use super::{details, sparks, words};
use crate::record::{Record, Row};
use crate::report::failures::experiment;
use crate::report::rows::{JoinedRow, joined};
use crate::report::totals;

/// The columns: title, and how its cells stand. The page's style says which are left out where there is no room.
const COLUMNS: [(&str, Option<&str>); 11] = [
    ("verdict", None),
    ("experiment", None),
    ("problem", None),
    ("medium", None),
    ("mean", Some("number")),
    ("z of mean", Some("number")),
    ("z of variance", Some("number")),
    ("z of lookups", Some("number")),
    ("largest ln E", Some("number")),
    ("ε", Some("number")),
    ("draws to verdict", Some("number")),
];

/// The table with its filters.
pub fn section(record: &Record, plots: &[Vec<Plot>]) -> Markup {
    let rows = joined(record);
    let gate = &record.results.gate;
    let limit = |limit| words::number(Some(limit), 3);
    let cases = &record.results.cases;
    let mut plots = cases.iter().zip(plots).flat_map(|(case, plots)| vec![plots; case.rows.len()]);
    html! {
        section aria-labelledby="experiments" {
            h2 #experiments { "Experiments" }
            (sparks::ground())
            (filters::form(&choices(&rows), rows.len()))
            table #table.experiments {
                caption.quiet { "A row opens by a click; z is sorted by its size. A check fails at ln E ≥ " (limit(gate.ln_e_limit))
                                " and passes where both ln P ≥ " (limit(gate.ln_p_limit)) ". " (words::UNKNOWN) " is unknown or without bound. "
                                (totals::NOT_NORMAL) "." }
                thead { tr { @for (title, class) in COLUMNS { th scope="col" class=[class] { (title) } } } }
                @for row in &rows { (body(row, plots.next().map_or(&[], |plots| plots))) }
            }
        }
    }
}

/// An experiment: its line, and the line that opens.
fn body(joined: &JoinedRow, plots: &[Plot]) -> Markup {
    let JoinedRow { case, row, .. } = joined;
    let word = row.verdict.map_or("undecided", |verdict| verdict.word());
    html! {
        tbody #(words::anchor(case, row)) data-verdict=(word) data-estimator=(family(row)) {
            tr {
                td class={ "verdict " (word) } { (words::verdict(row.verdict)) }
                th scope="row" {
                    details { summary { span.quiet { (case.name) } " " (experiment(case, row)) } }
                }
                td { (case.problem) }
                td { (case.medium) }
                td { (words::number(row.mean, 5)) }
                td { (words::z(row, "z_mean", row.z_mean)) }
                td { (words::z(row, "z_variance", row.z_variance)) }
                td { (words::z(row, "z_lookups", row.z_lookups)) }
                td { (largest(row)) }
                td { (words::number(row.detectable_bias, 3)) }
                td { (words::count(row.drawn)) }
            }
            tr.more { td colspan=(COLUMNS.len()) { (details::of(joined, plots)) } }
        }
    }
}

/// The largest ln E of its checks.
fn largest(row: &Row) -> String {
    let gates = row.findings.iter().filter_map(|finding| finding.gate);
    let largest = gates.map(|gate| words::ordered(gate.ln_e)).reduce(f64::max);
    largest.map_or_else(|| words::UNKNOWN.to_owned(), words::evidence)
}

/// The estimator without its settings.
fn family(row: &Row) -> &str {
    row.estimator.split('(').next().unwrap_or_default().trim_end()
}

/// What the table is filtered by, beside words.
fn choices(rows: &[JoinedRow]) -> Vec<Choice> {
    let verdict =
        |row: &JoinedRow| row.row.verdict.map_or("undecided", |verdict| verdict.word()).to_owned();
    vec![
        ("verdict", rows.iter().map(verdict).collect()),
        ("problem", rows.iter().map(|row| row.case.problem.clone()).collect()),
        ("medium", rows.iter().map(|row| row.case.medium.clone()).collect()),
        ("estimator", rows.iter().map(|row| family(row.row).to_owned()).collect()),
    ]
}

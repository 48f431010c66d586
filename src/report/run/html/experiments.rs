//! Table of all experiments, a row for each channel. Rows are hidden and moved by the page's script.

use maud::{Markup, html};

use super::{details, sparks};
use crate::record::{Record, Row, Score};
use crate::report::html::drawing::Plot;
use crate::report::html::listing::{self, Choice};
use crate::report::html::words;
use crate::report::run::totals;

/// Columns: title, and alignment of the cells. The page's style leaves some out on narrow screens.
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

/// Returns the table with its filters.
pub fn section(record: &Record, plots: &[Vec<Plot>]) -> Markup {
    let cases = record.results.cases.iter().zip(plots);
    let rows: Vec<(Row, &[Plot])> = cases
        .flat_map(|(case, plots)| case.rows().map(move |row| (row, plots.as_slice())))
        .collect();
    let gate = &record.results.gate;
    let limit = |limit| words::number(Some(limit), 3);
    html! {
        section aria-labelledby="experiments" {
            h2 #experiments { "Experiments" }
            (sparks::ground())
            (listing::form(&choices(&rows), rows.len()))
            table #table.experiments {
                caption.quiet { "A row opens by a click; z is sorted by its size. A check fails at ln E ≥ " (limit(gate.ln_e_limit))
                                " and passes where both ln P ≥ " (limit(gate.ln_p_limit)) ". " (words::UNKNOWN) " is unknown or without bound. "
                                (totals::NOT_NORMAL) "." }
                thead { tr { @for (title, class) in COLUMNS { th scope="col" class=[class] { (title) } } } }
                @for (row, plots) in &rows { (body(row, plots)) }
            }
        }
    }
}

/// Returns an experiment: its line, and the line that opens.
fn body(row: &Row, plots: &[Plot]) -> Markup {
    let case = row.case;
    let word = row.verdict.map_or("undecided", |verdict| verdict.word());
    html! {
        tbody #(words::anchor(row)) data-verdict=(word) data-estimator=(row.experiment.id.estimator.name) {
            tr {
                td class={ "verdict " (word) } { (words::verdict(row.verdict)) }
                th scope="row" {
                    details { summary { span.quiet { (case.name) } " " (row.name()) } }
                }
                td { (case.problem) }
                td { (case.medium) }
                td { (words::number(row.mean, 5)) }
                td { (words::z(row, Score::Mean, row.z_mean)) }
                td { (words::z(row, Score::Variance, row.z_variance)) }
                td { (words::z(row, Score::Lookups, row.experiment.z_lookups)) }
                td { (largest(row)) }
                td { (words::number(row.detectable_bias, 3)) }
                td { (words::count(row.experiment.drawn)) }
            }
            tr.more { td colspan=(COLUMNS.len()) { (details::of(row, plots)) } }
        }
    }
}

/// Returns the largest ln E of its checks.
fn largest(row: &Row) -> String {
    let gates = row.findings().filter_map(|finding| finding.gate);
    let largest = gates.map(|gate| words::ordered(gate.ln_e)).reduce(f64::max);
    largest.map_or_else(|| words::UNKNOWN.to_owned(), words::evidence)
}

/// Returns the filters of the table, besides text.
fn choices(rows: &[(Row, &[Plot])]) -> Vec<Choice> {
    let verdict = |row: &Row| row.verdict.map_or("undecided", |verdict| verdict.word()).to_owned();
    let values = |of: &dyn Fn(&Row) -> String| rows.iter().map(|(row, _)| of(row)).collect();
    vec![
        ("verdict", values(&verdict)),
        ("problem", values(&|row| row.case.problem.clone())),
        ("medium", values(&|row| row.case.medium.clone())),
        ("estimator", values(&|row| row.experiment.id.estimator.name.clone())),
    ]
}

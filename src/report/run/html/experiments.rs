//! Table of all experiments, a row for each channel, and its legend. Rows are hidden and moved by the page's script.

use crate::report::html::template::{Markup, html};

use super::details::{self, SharedContent};
use super::sparks;
use crate::record::{Record, Row};
use crate::report::fields::{Shown as Column, shown};
use crate::report::html::listing::{self, Choice};
use crate::report::html::words;
use crate::report::run::summary_csv::SummaryRow;
use crate::report::run::totals::{NOT_NORMAL, VERDICTS};

/// Fields beside the verdict and the experiment. The page's style leaves some out on narrow screens.
const COLUMNS: &[Column] = shown!(SummaryRow:
    "mean", "truth", "z_mean", "z_variance", "z_lookups", "largest_ln_e", "detectable_bias", "drawn"
);

/// Meanings of the first two columns.
const VERDICT: &str = "Worst result of all checks of the experiment. Sorted by severity.";
const EXPERIMENT: &str = "Case, estimator, sampling extinction σ̂, control, swept value, channel";

/// Returns the table with its filters.
pub fn section<'a>(record: &'a Record, shown: &SharedContent<'a>) -> Markup {
    let rows: Vec<(usize, Row)> = record
        .results
        .cases
        .iter()
        .enumerate()
        .flat_map(|(place, case)| case.rows().map(move |row| (place, row)))
        .collect();
    let columns: Vec<_> = COLUMNS.iter().map(|column| &shown.fields[column.place]).collect();
    html! {
        section aria-labelledby="experiments" {
            h2 #experiments { "Experiments" }
            (sparks::ground())
            (listing::form(&choices(&rows), rows.len()))
            table.experiments #table {
                thead { tr {
                    th scope="col" title=(VERDICT) { "verdict" }
                    th scope="col" title=(EXPERIMENT) { "experiment" }
                    @for field in &columns { th.number scope="col" title=(field.tip()) { (field.head) } }
                } }
                @for (place, row) in &rows {
                    tbody #(words::anchor(row)) data-verdict=(words::word(row.verdict)) data-case=(place) data-estimator=(row.experiment.id.estimator.name) {
                        tr {
                            td class={ "verdict " (words::word(row.verdict)) } { (words::verdict(row.verdict)) }
                            th scope="row" { details { summary { span.quiet { (row.case.name) } " " (row.name()) } } }
                            @for field in &columns { td { (words::field(field, &shown.line(*row))) } }
                        }
                        tr.more { td colspan=(COLUMNS.len() + 2) { (details::of(row, shown, *place)) } }
                    }
                }
            }
        }
    }
}

/// Returns the meanings of all verdicts and columns.
pub fn legend(record: &Record, shown: &SharedContent) -> Markup {
    let gate = &record.results.gate;
    let limit = |limit| words::number(Some(limit), 3);
    html! {
        section aria-labelledby="legend" {
            h2 #legend { "Legend" }
            dl.legend {
                @for known in VERDICTS {
                    dt class={ "verdict " (known.verdict.word()) } { (words::verdict(Some(known.verdict))) }
                    dd { (known.meaning) }
                }
                @for column in COLUMNS {
                    @let field = &shown.fields[column.place];
                    dt { (field.head) } dd { (field.tip()) }
                }
                dt { "(z)" } dd { "In parentheses: " (NOT_NORMAL.trim_start_matches("(z): ")) "." }
                dt { (words::UNKNOWN) } dd { "Unknown, or without bound." }
                dt { "ln E, ln P" }
                dd { "Evidence: a check fails at ln E ≥ " (limit(gate.ln_e_limit)) ", and passes where both ln P ≥ " (limit(gate.ln_p_limit)) "." }
            }
            p.quiet { "More is in the manual: docs/verdicts.md, docs/columns.md (all columns of the files), docs/failures.md, and "
                code { "trueflight explain NAME" } " for each estimator, medium and check." }
        }
    }
}

/// Returns the filters of the table, besides text.
fn choices(rows: &[(usize, Row)]) -> Vec<Choice> {
    let values = |of: &dyn Fn(&Row) -> String| rows.iter().map(|(_, row)| of(row)).collect();
    vec![
        ("verdict", values(&|row| words::word(row.verdict).to_owned())),
        ("problem", values(&|row| row.case.problem.clone())),
        ("medium", values(&|row| row.case.medium.clone())),
        ("estimator", values(&|row| row.experiment.id.estimator.name.clone())),
    ]
}

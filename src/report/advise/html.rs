//! `report.html` of an advice: the ranking, the figure, and the lines for a case.

use crate::report::html::template::html;

use super::{AdviceRow, console};
use crate::advise::Advice;
use crate::report::ReportError;
use crate::report::fields::{Shown, shown};
use crate::report::html::drawing::{definitions, plot};
use crate::report::html::listing::{page, section};

/// Columns of the page, beside the rank.
const COLUMNS: &[Shown] = shown!(AdviceRow:
    "group", "estimator", "sampling", "sampling_factor", "sampling_kind", "control", "cost", "error",
    "relative_deviation", "lookups_per_draw", "margin_below", "margin_above", "least_sampling", "kurtosis",
    "trusted_draws", "needs"
);

/// Returns the advice as a page of HTML.
pub fn text(advice: &Advice) -> Result<String, ReportError> {
    let rows: Vec<AdviceRow> = super::joined(advice).collect();
    let best = advice.best();
    let line = best.map_or("nothing can be advised".to_owned(), |row| {
        format!("{} with σ\u{302} {}", row.estimator, console::sampling(row))
    });
    let label =
        "cost against the sampling extinction, and the best sampling extinction along the ray";
    let plots = [vec![plot("costs".to_owned(), label.to_owned(), &super::plot::figure(advice)?)]];
    let head = html! {
        p { (console::facts(advice)) }
        @if let Some(row) = best { pre { (row.lines) } }
        @for note in console::notes(advice) { p { (note) } }
    };
    let group = |of: &AdviceRow| of.row.group.word().to_owned();
    let title = "Estimators with their best settings";
    let sections = html! {
        (definitions(&plots))
        (section(title, "rank", |of| ("", console::rank(of.row)), COLUMNS, &rows, group))
        section aria-labelledby="figure" {
            h2 #figure { "Cost against σ\u{302}" }
            (plots[0][0].show())
        }
    };
    Ok(page(&format!("advice for {}", advice.case), ("pass", &line), &head, &sections))
}

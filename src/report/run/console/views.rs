//! Columns of each view of the table, and their content.

use crate::case::sweep::SweptQuantity;
use crate::record::{CaseRecord, Digits, Row, Verdict};
use crate::report::fields::{Shown, Table, grid, shown};
use crate::report::layout::{Column, LayoutField, Paint};
use crate::report::run::console::TableView;
use crate::report::run::summary_csv::SummaryRow;

const RUN: &[Shown] = shown!(SummaryRow:
    "mean" 6, "z_mean" 1, "variance_ratio" 5, "z_variance" 2, "lookups_per_draw" 7, "z_lookups" 4,
    "predicted_kurtosis" 9, "fom" 8, "log10_ltuv" 10, "setup" 8, "needs" 9
);

const PREDICT: &[Shown] = shown!(SummaryRow:
    "predicted_variance" 1, "predicted_skewness" 9, "predicted_kurtosis" 5, "predicted_lookups" 2, "setup" 3,
    "predicted_fom" 2, "predicted_log10_ltuv" 10, "stable_share" 6, "rare_event_size" 8, "best_sampling_marked" 3,
    "best_fom_marked" 4, "needs" 5
);

const MOMENTS: &[Shown] = shown!(SummaryRow:
    "loss_1", "loss_2", "loss_3", "loss_4", "relative_m2", "relative_m3", "relative_m4", "moments_error",
    "error_grade", "predicted_lookups", "lookups_spread", "lookups_error", "lookups_grade", "lookups_moments_error", "walk_lookups",
    "shadow_lookups", "covariance", "rare_event_size", "setup", "best_sampling_marked", "best_fom_marked",
    "best_kind", "best_limit", "needs"
);

/// Columns that stand above the table if all rows share their value: draws of a plan and of a run, drawn, truth.
const SHARED: &[Shown] = shown!(SummaryRow: "draws" 2, "draws" 10, "drawn" 3, "truth" 11);

const PLAN: &[Shown] = shown!(SummaryRow:
    "needed" 1, "predicted_lookups" 2, "setup" 3, "needs" 5, "skipped" 3
);

/// Field of the lookups before the first draw of a ray.
pub const SETUP: &str = "setup";
/// Field of what estimators need beside lookups.
pub const NEEDS: &str = "needs";
/// Headings of z-scores.
pub const SCORES: [&str; 3] = ["z", "z_V", "z_N"];

/// Returns the columns that name the rows of a case, empty ones included.
pub fn names(case: &CaseRecord, rows: &[Row], labels: Digits) -> Vec<Column> {
    let column = |what, text: &dyn Fn(&Row) -> String| Column::of(rows, what, text);
    let sampling = |row: &Row| match row.experiment.sampling() {
        Some(sampling) => labels.text(sampling),
        None => row.experiment.id.sampling.kind.clone(),
    };
    let mut columns = vec![
        column(("estimator", false, 0), &|row| row.experiment.label.clone()),
        column(("σ\u{302}", true, 1), &sampling),
    ];
    if let Some(head) = swept_apart(case.sweep.as_ref().map(|sweep| sweep.what)) {
        let swept = |row: &Row| row.experiment.swept().map(|x| labels.text(x)).unwrap_or_default();
        columns.push(column((head, true, 1), &swept));
    }
    columns.push(column(("control", false, 3), &|row| row.experiment.id.control.clone()));
    columns.push(column(("channel", false, 1), &|row| row.channel.clone()));
    columns
}

/// Returns the columns about the results of the rows, empty ones included.
pub fn columns(lines: &[SummaryRow], view: TableView) -> Vec<Column> {
    let rows: Vec<Row> = lines.iter().map(|line| line.row).collect();
    let mut shown: Vec<Shown> = Vec::new();
    if !view.is_theory() && shared(&rows, |row| row.experiment.draws).is_none() {
        shown.push(SHARED[usize::from(view != TableView::Plan)]);
    }
    if view == TableView::Run && shared(&rows, |row| row.experiment.drawn).is_none() {
        shown.push(SHARED[2]);
    }
    if view != TableView::Plan && shared(&rows, |row| row.truth).is_none() {
        shown.push(SHARED[3]);
    }
    shown.extend(match view {
        TableView::Run => RUN,
        TableView::Predict => PREDICT,
        TableView::Moments => MOMENTS,
        TableView::Plan => PLAN,
    });
    let has_channels = rows.iter().any(|row| !row.channel.is_empty());
    shown.retain(|column| has_channels || !SummaryRow::NAMES[column.place].ends_with("ltuv"));
    let mut columns = grid(lines, &shown).columns;
    let head = if view == TableView::Run { "verdict" } else { "status" };
    let fields = rows.iter().map(|row| status(row, view)).collect();
    columns.push(Column { head, right: false, rank: 0, fields });
    columns
}

/// Returns the heading of the swept quantity if it is not the sampling extinction itself.
pub fn swept_apart(swept: Option<SweptQuantity>) -> Option<&'static str> {
    match swept? {
        SweptQuantity::Sampling => None,
        SweptQuantity::SamplingScale => Some("σ\u{302} scale"),
        SweptQuantity::AlbedoScale => Some("albedo scale"),
        SweptQuantity::Control => Some("swept"),
        other => Some(other.key()),
    }
}

/// Returns the value that all rows with a value share, if there are at least two.
pub fn shared<T: PartialEq>(rows: &[Row], value: fn(&Row) -> Option<T>) -> Option<T> {
    let mut known = rows.iter().filter_map(value);
    let first = known.next()?;
    let mut others = known.peekable();
    others.peek()?;
    others.all(|other| other == first).then_some(first)
}

/// Returns the places of these rows in their case, in words: `σ̂ 0.4, 0.5; T(5)`.
pub fn positions(case: &CaseRecord, rows: &[&Row], labels: Digits) -> String {
    let mut swept: Vec<_> =
        rows.iter().filter_map(|row| Some(labels.text(row.experiment.swept()?))).collect();
    let mut channels: Vec<_> = rows.iter().map(|row| row.channel.clone()).collect();
    channels.retain(|channel| !channel.is_empty());
    for list in [&mut swept, &mut channels] {
        list.dedup();
    }
    let mut parts = Vec::new();
    if !swept.is_empty() {
        let what = case.sweep.as_ref().map(|sweep| sweep.what);
        let name = swept_apart(what).unwrap_or("σ\u{302}");
        parts.push(format!("{name} {}", swept.join(", ")));
    }
    if !channels.is_empty() {
        parts.push(channels.join(", "));
    }
    parts.join("; ")
}

/// Returns whether a row is planned but neither drawn nor refused, for a reason.
pub fn is_skipped(row: &Row, view: TableView) -> bool {
    view == TableView::Plan
        && row.verdict.is_none()
        && row.experiment.draws.is_none()
        && !row.reason().is_empty()
}

/// Returns the word for the result of a row.
pub fn status(row: &Row, view: TableView) -> LayoutField {
    let foreseen = || row.foreseen.as_ref().map(|foreseen| foreseen.verdict);
    match row.verdict.or_else(foreseen) {
        Some(verdict) => LayoutField { text: verdict.word().to_owned(), paint: paint(verdict) },
        None if is_skipped(row, view) => {
            LayoutField { text: "skipped".to_owned(), paint: Paint::Dim }
        }
        None => LayoutField::plain(String::new()),
    }
}

/// Returns the colour of a verdict.
pub fn paint(verdict: Verdict) -> Paint {
    match verdict {
        Verdict::Pass => Paint::Green,
        Verdict::Fail => Paint::Red,
        Verdict::Inconclusive => Paint::Yellow,
        Verdict::Underpowered | Verdict::Refused => Paint::Dim,
    }
}

//! Columns of each view of the table, and their content.

use crate::record::{Best, CaseRecord, Digits, Row, Score, Verdict};
use crate::report::layout::{Column, Field, Paint};
use crate::report::run::console::View;
use numeric::digits::{count, enough, fixed, percent, short, signed};

/// Column of rows: heading, whether it is aligned to the right, rank, and text.
pub type Spec = (&'static str, bool, u8, fn(&Row) -> String);

const DRAWS: Spec = ("draws", true, 10, |row| row.experiment.draws.map(count).unwrap_or_default());
/// Number of draws that the gate took; the columns beside it are of the fixed draws.
const DRAWN: Spec = ("drawn", true, 3, |row| row.experiment.drawn.map(count).unwrap_or_default());
const TRUTH: Spec = ("truth", true, 11, |row| digits(row.truth, 6));

/// Lookups before the first draw of a ray; empty if no row of a case has any.
pub const SETUP: Spec = ("setup", true, 3, |row| {
    row.experiment.setup_lookups.filter(|&lookups| lookups > 0).map(count).unwrap_or_default()
});
/// Knowledge that estimators need beside lookups, as in `τ`.
pub const NEEDS: Spec = ("needs", false, 5, |row| row.experiment.needs.clone());

/// Headings of z.
pub const SCORES: [&str; 3] = ["z", "z_V", "z_N"];

/// log₁₀ of variance · lookups, for problems with channels.
const LTUV: &str = "lg LTUV";

const RUN: &[Spec] = &[
    ("mean", true, 6, |row| digits(row.mean, 6)),
    ("z", true, 1, |row| score(row, Score::Mean, row.z_mean)),
    ("s²/V", true, 5, ratio),
    ("z_V", true, 2, |row| score(row, Score::Variance, row.z_variance)),
    ("lookups", true, 7, |row| digits(row.experiment.lookups_per_draw, 4)),
    ("z_N", true, 4, |row| score(row, Score::Lookups, row.experiment.z_lookups)),
    ("κ", true, 9, |row| digits(row.predicted_kurtosis, 3)),
    ("FoM", true, 8, |row| digits(row.fom, 4)),
    (LTUV, true, 10, |row| of_channel(row, row.log10_ltuv())),
    ("setup", true, 8, SETUP.3),
    ("needs", false, 9, NEEDS.3),
];

const PREDICT: &[Spec] = &[
    ("variance", true, 1, |row| digits(row.predicted_variance, 4)),
    ("skewness", true, 9, |row| digits(row.predicted_skewness, 3)),
    ("κ", true, 5, |row| digits(row.predicted_kurtosis, 3)),
    ("lookups", true, 2, |row| digits(row.experiment.predicted_lookups, 4)),
    SETUP,
    ("FoM", true, 2, |row| digits(row.predicted_fom, 4)),
    (LTUV, true, 10, |row| of_channel(row, row.predicted_log10_ltuv())),
    ("stable", true, 6, |row| row.experiment.stable_share.map(percent).unwrap_or_default()),
    ("n(2)", true, 8, |row| digits(row.rare_event_size, 3)),
    ("best σ\u{302}", true, 3, best_sampling),
    ("best FoM", true, 4, best_fom),
    NEEDS,
];

const MOMENTS: &[Spec] = &[
    ("J₁", true, 0, |row| loss(row, 1)),
    ("J₂", true, 0, |row| loss(row, 2)),
    ("J₃", true, 0, |row| loss(row, 3)),
    ("J₄", true, 0, |row| loss(row, 4)),
    ("m₂", true, 0, |row| digits(row.relative_moments[0], 4)),
    ("m₃", true, 0, |row| digits(row.relative_moments[1], 4)),
    ("m₄", true, 0, |row| digits(row.relative_moments[2], 4)),
    ("m error", true, 0, |row| digits(row.moments_error, 2)),
    ("lookups", true, 0, |row| digits(row.experiment.predicted_lookups, 4)),
    ("± σ", true, 0, |row| digits(row.experiment.lookups_variance.map(f64::sqrt), 4)),
    ("N error", true, 0, |row| digits(row.experiment.lookups_error, 2)),
    ("Cov next", true, 0, |row| digits(row.covariance, 4)),
    ("n(2)", true, 0, |row| digits(row.rare_event_size, 3)),
    ("setup", true, 0, SETUP.3),
    ("best σ\u{302}", true, 0, best_sampling),
    ("best FoM", true, 0, best_fom),
    ("best is", false, 0, |row| row.best_kind().to_owned()),
    ("limit", true, 0, |row| digits(row.best_limit(), 4)),
    ("needs", false, 0, NEEDS.3),
];

const PLAN: &[Spec] = &[
    ("needed", true, 1, |row| row.needed_draws.map(enough).unwrap_or_default()),
    ("lookups", true, 2, |row| digits(row.experiment.predicted_lookups, 4)),
    SETUP,
    NEEDS,
    ("skipped", true, 3, |row| row.experiment.skipped.map(percent).unwrap_or_default()),
];

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
    if let Some(head) = swept_apart(case.sweep.as_ref().map(|sweep| &*sweep.what)) {
        let swept = |row: &Row| row.experiment.swept().map(|x| labels.text(x)).unwrap_or_default();
        columns.push(column((head, true, 1), &swept));
    }
    columns.push(column(("control", false, 3), &|row| row.experiment.id.control.clone()));
    columns.push(column(("channel", false, 1), &|row| row.channel.clone()));
    columns
}

/// Returns the columns about the results of the rows, empty ones included.
pub fn columns(rows: &[Row], view: View) -> Vec<Column> {
    let mut specs: Vec<Spec> = Vec::new();
    // A number of draws that all rows share stands above the table.
    if !view.is_theory() && shared(rows, |row| row.experiment.draws).is_none() {
        specs.push(if view == View::Plan { (DRAWS.0, DRAWS.1, 2, DRAWS.3) } else { DRAWS });
    }
    if view == View::Run && shared(rows, |row| row.experiment.drawn).is_none() {
        specs.push(DRAWN);
    }
    if view != View::Plan && shared(rows, |row| row.truth).is_none() {
        specs.push(TRUTH);
    }
    specs.extend(match view {
        View::Run => RUN,
        View::Predict => PREDICT,
        View::Moments => MOMENTS,
        View::Plan => PLAN,
    });
    let column = |(head, right, rank, text): Spec| Column::of(rows, (head, right, rank), text);
    let mut columns: Vec<Column> = specs.into_iter().map(column).collect();
    let head = if view == View::Run { "verdict" } else { "status" };
    let fields = rows.iter().map(|row| status(row, view)).collect();
    columns.push(Column { head, right: false, rank: 0, fields });
    columns
}

/// Returns the heading of the swept quantity if it is not the sampling extinction itself.
pub fn swept_apart(swept: Option<&str>) -> Option<&'static str> {
    match swept? {
        "sampling" => None,
        "sampling-scale" => Some("σ\u{302} scale"),
        "albedo" => Some("albedo"),
        "points" => Some("points"),
        "density" => Some("density"),
        "albedo-scale" => Some("albedo scale"),
        "contrast" => Some("contrast"),
        _ => Some("swept"),
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
        let what = case.sweep.as_ref().map(|sweep| &*sweep.what);
        let name = swept_apart(what).unwrap_or("σ\u{302}");
        parts.push(format!("{name} {}", swept.join(", ")));
    }
    if !channels.is_empty() {
        parts.push(channels.join(", "));
    }
    parts.join("; ")
}

/// Returns whether a row is planned but neither drawn nor refused, for a reason.
pub fn is_skipped(row: &Row, view: View) -> bool {
    view == View::Plan
        && row.verdict.is_none()
        && row.experiment.draws.is_none()
        && !row.reason.is_empty()
}

/// Returns the word for the result of a row.
pub fn status(row: &Row, view: View) -> Field {
    let status_of = |verdict: Option<Verdict>| {
        let paint = verdict.map_or(Paint::Plain, paint);
        Field { text: verdict.map_or("", Verdict::word).to_owned(), paint }
    };
    match row.verdict {
        Some(_) => status_of(row.verdict),
        None if row.foreseen.is_some() => status_of(row.foreseen),
        None if is_skipped(row, view) => Field { text: "skipped".to_owned(), paint: Paint::Dim },
        None => Field::plain(String::new()),
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

/// Returns `J_k`.
fn loss(row: &Row, k: usize) -> String {
    digits(row.losses.map(|losses| losses[k - 1]), 4)
}

fn digits(value: Option<f64>, digits: usize) -> String {
    value.map(|value| fixed(value, digits)).unwrap_or_default()
}

/// Returns text about the best σ̂; empty if it was not searched.
fn best(row: &Row, text: fn(&Best) -> String) -> String {
    row.best.as_ref().map(text).unwrap_or_default()
}

/// Returns the best σ̂, marked if it is a share of a limit.
fn best_sampling(row: &Row) -> String {
    best(row, |best| {
        let mark = if best.limit.is_some() { " (90 %)" } else { "" };
        format!("{}{mark}", short(best.sampling, 4))
    })
}

/// Returns the figure of merit at the best σ̂, which is infinite without a variance.
fn best_fom(row: &Row) -> String {
    best(row, |best| best.fom.map_or("∞".to_owned(), |fom| fixed(fom, 4)))
}

/// Returns a number with two decimals, for problems with several channels only.
fn of_channel(row: &Row, value: Option<f64>) -> String {
    let value = value.filter(|_| !row.channel.is_empty());
    value.map(signed).unwrap_or_default()
}

/// Returns a z, in parentheses if it is not to be read as normal.
pub fn score(row: &Row, score: Score, z: Option<f64>) -> String {
    let text = z.map(signed).unwrap_or_default();
    if row.not_normal.contains(&score) { format!("({text})") } else { text }
}

/// Returns the measured variance over the predicted one.
fn ratio(row: &Row) -> String {
    match (row.variance, row.predicted_variance) {
        (Some(measured), Some(predicted)) if predicted > 0.0 => {
            format!("{:.3}", measured / predicted)
        }
        _ => String::new(),
    }
}

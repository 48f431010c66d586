//! Tables of the stress test on the screen, as CSV and as JSON, and single precision as CSV and a plot.

mod html;
mod plot;

use std::fmt::Write;

use serde_json::json;

use crate::stress::narrow::{Along, BothPrecisions, DRAWS, PrecisionCurve};
use crate::stress::{Stress, TrialRow};
use numeric::digits::{number, short};
use trueflight::report::fields::{self, Shown, Table, judged, object, place, shown, table};
use trueflight::report::layout::{Column, LayoutField, Paint, Pen, TableLayout};
use trueflight::report::plots;
use trueflight::report::{Artifact, ReportError};

/// Folder below the results.
const FOLDER: &str = "stress";

/// Columns of the screen beside the result, each with its rank.
const COLUMNS: &[Shown] = shown!(&TrialRow:
    "quantity", "range" 2, "trials" 1, "left_out" 1, "worst", "bound", "measure"
);

/// Returns the tables for the screen.
pub fn table(stress: &Stress, pen: Pen) -> String {
    let mut text = String::new();
    let rows: Vec<&TrialRow> = stress.rows.iter().collect();
    text.push_str(&judged(&rows, COLUMNS, ("holds", ["yes", "NO"]), |row| row.holds(), pen));
    for row in rows.iter().filter(|row| !row.holds()) {
        let said = if row.is_mostly_skipped() {
            let TrialRow { quantity, skipped, trials, first_skipped, .. } = row;
            format!(
                "{quantity}: {skipped} skipped, {trials} compared; first skipped: {first_skipped}"
            )
        } else {
            format!("{}: {} at {}", row.quantity, number(row.worst), row.place)
        };
        pen.say(&mut text, Paint::Red, &said);
    }
    text.push('\n');
    single_precision(&mut text, pen, &stress.narrow.curves);
    let broken = rows.iter().filter(|row| !row.holds()).count();
    let verdict = if broken == 0 {
        pen.paint(Paint::Green, &format!("all {} bounds hold", rows.len()))
    } else {
        pen.paint(Paint::Red, &format!("{broken} of {} bounds are broken", rows.len()))
    };
    let _ = writeln!(text, "{verdict} · {} s", short(stress.seconds, 3));
    text
}

fn single_precision(text: &mut String, pen: Pen, curves: &[PrecisionCurve]) {
    let title =
        format!("single precision: its bias exceeds the error of {} draws from …", number(DRAWS));
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &title));
    let estimators: Vec<&PrecisionCurve> =
        curves.iter().filter(|curve| curve.along == Along::Steps).collect();
    let of = |along: Along| -> Vec<LayoutField> {
        let curves = curves.iter().filter(|curve| curve.along == along);
        let words = curves.map(|curve| {
            let nowhere = || match curve.holds_to() {
                Some(x) => format!("> {}", short(x, 3)),
                None if curve.points.is_empty() => String::new(),
                None => "not resolved".to_owned(),
            };
            curve.fails_from().map_or_else(nowhere, |x| short(x, 3))
        });
        words.map(LayoutField::plain).collect()
    };
    let names =
        estimators.iter().map(|curve| LayoutField::plain(curve.estimator.to_owned())).collect();
    let column = |head, along| Column { head, right: true, rank: 0, fields: of(along) };
    let mut grid = TableLayout {
        columns: vec![
            Column { head: "estimator", right: false, rank: 0, fields: names },
            column("collisions", Along::Steps),
            column("optical depth", Along::Depth),
            column("origin, in lengths", Along::Origin),
        ],
    };
    grid.fit(pen.width);
    let _ = writeln!(text, "{}", grid.render(pen));
}

/// Returns the tables as JSON; numbers that are not finite are null.
fn json(stress: &Stress) -> Result<String, ReportError> {
    let (fields, of_points) = (<&TrialRow>::of_files(), PrecisionPoint::fields());
    let curves = stress.narrow.curves.iter().map(|curve| {
        let point = |row| object(&of_points[OF_CURVES..], &row);
        json!({
            "family": curve.family,
            "estimator": curve.estimator,
            "along": curve.along.word(),
            "fails_from": curve.fails_from(),
            "points": points(curve).map(point).collect::<Vec<_>>(),
        })
    });
    let rows = stress.rows.iter().map(|row| object(&fields, &row));
    let document = json!({
        "schema": 1,
        "holds": stress.holds(),
        "rows": rows.collect::<Vec<_>>(),
        "single_precision": curves.collect::<Vec<_>>(),
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

table! {
    impl<'a> for &'a TrialRow {
        "quantity": "Quantity that is computed" = |row| &row.quantity;
        "range": "Range of its arguments" = |row| &row.range;
        "trials": "Number of arguments that were compared" = |row| row.trials;
        "skipped": "Number that were left out, for no reference is exact there" = |row| row.skipped;
        "measure" ["in", "", Plain]: "Measure of the error" = |row| row.measure.words();
        "worst" ["worst", "", Short(2)]: "Largest error" = |row| row.worst;
        "bound" ["bound", "", Short(2)]: "Promised bound" = |row| row.bound;
        "where": "Argument of the largest error" = |row| &row.place;
        "holds": "Whether the bound holds" = |row| row.holds();
    } screens {
        "left_out" ["skipped", "", Plain]: "Number of arguments that were left out, if there are any" = |row| Some(row.skipped).filter(|&skipped| skipped > 0);
    }
}

/// Point of a curve of single precision.
#[derive(Debug, Clone, Copy)]
pub struct PrecisionPoint<'a> {
    curve: &'a PrecisionCurve,
    point: &'a BothPrecisions,
}

fn points(curve: &PrecisionCurve) -> impl Iterator<Item = PrecisionPoint<'_>> {
    curve.points.iter().map(move |point| PrecisionPoint { curve, point })
}

/// Number of fields of a point that all points of its curve share.
const OF_CURVES: usize = place::<PrecisionPoint>("x");

table! {
    impl<'a> for PrecisionPoint<'a> {
        "family": "Family of estimators" = |PrecisionPoint { curve, .. }| curve.family;
        "estimator": "Estimator" = |PrecisionPoint { curve, .. }| curve.estimator;
        "along": "Quantity that is varied" = |PrecisionPoint { curve, .. }| curve.along.word();
        "x": "Its value" = |PrecisionPoint { point, .. }| point.x;
        "walks": "Number of walks" = |PrecisionPoint { point, .. }| point.walks;
        "bias": "Bias of single precision, relative to the mean" = |PrecisionPoint { point, .. }| point.bias;
        "bias_error": "Its standard error" = |PrecisionPoint { point, .. }| point.error;
        "noise_1e8": "Relative standard error of 1e8 draws" = |PrecisionPoint { point, .. }| point.noise;
        "exceeds": "Whether the bias exceeds the noise" = |PrecisionPoint { point, .. }| point.exceeds();
    }
}

/// Returns the tables as CSV and JSON and the plot of single precision, all below `stress/`.
pub fn artifacts(stress: &Stress) -> Result<Vec<Artifact>, ReportError> {
    let points = stress.narrow.curves.iter().flat_map(points);
    let path = |name: &str| format!("{FOLDER}/{name}");
    let mut all = vec![
        fields::artifact(&path("stress.csv"), &<&TrialRow>::of_files(), &stress.rows)?,
        Artifact::text(path("stress.json"), json(stress)?),
        fields::artifact(&path("single-precision.csv"), &PrecisionPoint::fields(), points)?,
        Artifact::text(path("report.html"), html::text(stress)?),
    ];
    let sheet = plot::figure(&stress.narrow.curves)?;
    all.extend(plots::artifacts(&format!("{FOLDER}/single-precision"), "", &sheet)?);
    Ok(all)
}

//! Tables of the stress test on the screen, as CSV and as JSON, and single precision as CSV and a plot.

mod html;
mod plot;

use std::fmt::Write;

use serde_json::json;

use crate::report::fields::{self, fields};
use crate::report::layout::{Column, Field, Grid, Paint, Pen, wrapped};
use crate::report::plots;
use crate::report::{Artifact, ReportError};
use crate::stress::narrow::{Along, Curve, DRAWS, Point};
use crate::stress::{Row, Stress};
use numeric::digits::{count, exact, short};

/// Folder below the results.
const FOLDER: &str = "stress";

/// Returns the tables for the screen.
pub fn table(found: &Stress, pen: Pen) -> String {
    let mut text = String::new();
    let rows = &found.rows;
    let column = |head, right, rank, field: &dyn Fn(&Row) -> String| Column {
        head,
        right,
        rank,
        fields: rows.iter().map(|row| Field::plain(field(row))).collect(),
    };
    let holds = |row: &Row| {
        let (word, paint) = if row.holds() { ("yes", Paint::Green) } else { ("NO", Paint::Red) };
        Field { text: word.to_owned(), paint }
    };
    let mut grid = Grid {
        columns: vec![
            column("quantity", false, 0, &|row| row.quantity.clone()),
            column("range", false, 2, &|row| row.range.clone()),
            column("trials", true, 1, &|row| count(row.trials)),
            column("skipped", true, 1, &|row| match row.skipped {
                0 => String::new(),
                skipped => count(skipped),
            }),
            column("worst", true, 0, &|row| short(row.worst, 2)),
            column("bound", true, 0, &|row| short(row.bound, 2)),
            column("in", false, 0, &|row| row.measure.words().to_owned()),
            Column {
                head: "holds",
                right: false,
                rank: 0,
                fields: rows.iter().map(holds).collect(),
            },
        ],
    };
    grid.fit(pen.width);
    text.push_str(&grid.render(pen));
    for row in rows.iter().filter(|row| !row.holds()) {
        let said = if row.is_mostly_skipped() {
            let Row { quantity, skipped, trials, first_skipped, .. } = row;
            format!(
                "{quantity}: {skipped} skipped, {trials} compared; first skipped: {first_skipped}"
            )
        } else {
            format!("{}: {} at {}", row.quantity, exact(row.worst), row.place)
        };
        for line in wrapped(&said, pen.width) {
            let _ = writeln!(text, "{}", pen.paint(Paint::Red, &line));
        }
    }
    text.push('\n');
    single_precision(&mut text, pen, &found.narrow.curves);
    let broken = rows.iter().filter(|row| !row.holds()).count();
    let verdict = if broken == 0 {
        pen.paint(Paint::Green, &format!("all {} bounds hold", rows.len()))
    } else {
        pen.paint(Paint::Red, &format!("{broken} of {} bounds are broken", rows.len()))
    };
    let _ = writeln!(text, "{verdict} · {} s", short(found.seconds, 3));
    text
}

fn single_precision(text: &mut String, pen: Pen, curves: &[Curve]) {
    let title =
        format!("single precision: its bias exceeds the error of {} draws from …", exact(DRAWS));
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &title));
    let estimators: Vec<&Curve> =
        curves.iter().filter(|curve| curve.along == Along::Steps).collect();
    let of = |along: Along| -> Vec<Field> {
        let curves = curves.iter().filter(|curve| curve.along == along);
        let words = curves.map(|curve| {
            let nowhere = || match curve.holds_to() {
                Some(x) => format!("> {}", short(x, 3)),
                None if curve.points.is_empty() => String::new(),
                None => "not resolved".to_owned(),
            };
            curve.fails_from().map_or_else(nowhere, |x| short(x, 3))
        });
        words.map(Field::plain).collect()
    };
    let names = estimators.iter().map(|curve| Field::plain(curve.estimator.to_owned())).collect();
    let column = |head, along| Column { head, right: true, rank: 0, fields: of(along) };
    let mut grid = Grid {
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
fn json(found: &Stress) -> Result<String, ReportError> {
    let row = |row: &Row| {
        json!({
            "quantity": row.quantity,
            "range": row.range,
            "trials": row.trials,
            "skipped": row.skipped,
            "measure": row.measure.words(),
            "worst": row.worst,
            "bound": row.bound,
            "place": row.place,
            "holds": row.holds(),
        })
    };
    let point = |point: &Point| {
        json!({
            "x": point.x,
            "walks": point.walks,
            "bias": point.bias,
            "error": point.error,
            "noise": point.noise,
            "exceeds": point.exceeds(),
        })
    };
    let curve = |curve: &Curve| {
        json!({
            "family": curve.family,
            "estimator": curve.estimator,
            "along": curve.along.word(),
            "fails_from": curve.fails_from(),
            "points": curve.points.iter().map(point).collect::<Vec<_>>(),
        })
    };
    let document = json!({
        "schema": 1,
        "holds": found.holds(),
        "rows": found.rows.iter().map(row).collect::<Vec<_>>(),
        "single_precision": found.narrow.curves.iter().map(curve).collect::<Vec<_>>(),
    });
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

/// Returns the fields of bounds.
pub fn of_rows<'a>() -> Vec<fields::Field<&'a Row>> {
    fields! {
        "quantity": "Quantity that is computed" = |row| &row.quantity;
        "range": "Range of its arguments" = |row| &row.range;
        "trials": "Number of arguments that were compared" = |row| row.trials;
        "skipped": "Number that were left out, for no reference is exact there" = |row| row.skipped;
        "measure" ["in", "", Plain]: "Measure of the error" = |row| row.measure.words();
        "worst" ["worst", "", Short(3)]: "Largest error" = |row| row.worst;
        "bound" ["bound", "", Short(3)]: "Promised bound" = |row| row.bound;
        "where": "Argument of the largest error" = |row| &row.place;
        "holds": "Whether the bound holds" = |row| row.holds();
    }
}

/// Returns the fields of points of single precision.
pub fn of_points<'a>() -> Vec<fields::Field<(&'a Curve, &'a Point)>> {
    fields! {
        "family": "Family of estimators" = |(curve, _)| curve.family;
        "estimator": "Estimator" = |(curve, _)| curve.estimator;
        "along": "Quantity that is varied" = |(curve, _)| curve.along.word();
        "x": "Its value" = |(_, point)| point.x;
        "walks": "Number of walks" = |(_, point)| point.walks;
        "bias": "Bias of single precision, relative to the mean" = |(_, point)| point.bias;
        "bias_error": "Its standard error" = |(_, point)| point.error;
        "noise_1e8": "Relative standard error of 1e8 draws" = |(_, point)| point.noise;
        "exceeds": "Whether the bias exceeds the noise" = |(_, point)| point.exceeds();
    }
}

/// Returns the tables as CSV and JSON and the plot of single precision, all below `stress/`.
///
/// # Errors
///
/// An encoder or the painter fails.
pub fn artifacts(found: &Stress) -> Result<Vec<Artifact>, ReportError> {
    let stress = fields::csv("the stress test", &of_rows(), &found.rows)?;
    let curves = found.narrow.curves.iter();
    let points = curves.flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
    let narrow = fields::csv("single precision", &of_points(), points)?;
    let artifact = |name: &str, text: String| Artifact {
        path: format!("{FOLDER}/{name}").into(),
        bytes: text.into_bytes(),
    };
    let mut all = vec![
        artifact("stress.csv", stress),
        artifact("stress.json", json(found)?),
        artifact("single-precision.csv", narrow),
        artifact("report.html", html::text(found)?),
    ];
    let sheet = plot::figure(&found.narrow.curves)?;
    all.extend(plots::artifacts(&format!("{FOLDER}/single-precision"), "", &sheet)?);
    Ok(all)
}

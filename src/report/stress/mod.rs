//! Tables of the stress test on the screen, as CSV and as JSON, and single precision as CSV and a plot.

mod html;
mod plot;

use std::fmt::Write;

use serde_json::json;

use crate::report::columns::table as csv;
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

/// Returns the tables as CSV and JSON and the plot of single precision, all below `stress/`.
///
/// # Errors
///
/// An encoder or the painter fails.
pub fn artifacts(found: &Stress) -> Result<Vec<Artifact>, ReportError> {
    let rows = found.rows.iter().map(|row| {
        vec![
            row.quantity.clone(),
            row.range.clone(),
            row.trials.to_string(),
            row.skipped.to_string(),
            row.measure.words().to_owned(),
            exact(row.worst),
            exact(row.bound),
            row.place.clone(),
            row.holds().to_string(),
        ]
    });
    let header =
        ["quantity", "range", "trials", "skipped", "measure", "worst", "bound", "where", "holds"];
    let stress = csv("the stress test", header, rows)?;
    let points = found.narrow.curves.iter().flat_map(|curve| {
        curve.points.iter().map(|point| {
            vec![
                curve.family.to_owned(),
                curve.estimator.to_owned(),
                curve.along.word().to_owned(),
                exact(point.x),
                exact(point.walks),
                exact(point.bias),
                exact(point.error),
                exact(point.noise),
                point.exceeds().to_string(),
            ]
        })
    });
    let header = [
        "family",
        "estimator",
        "along",
        "x",
        "walks",
        "bias",
        "bias_error",
        "noise_1e8",
        "exceeds",
    ];
    let narrow = csv("single precision", header, points)?;
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

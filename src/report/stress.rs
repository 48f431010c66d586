//! The stress test's table on the screen, as CSV and as JSON, and single precision as CSV and a plot.

use std::fmt::Write;

use plotters::style::Color;
use serde::Serialize;

use crate::harness::stress::narrow::{Along, Curve, DRAWS, Point};
use crate::harness::stress::{Row, Stress};
use crate::report::console::layout::{Column, Field, Grid, Paint, Pen, wrapped};
use crate::report::number::{count, exact, short};
use crate::report::plots::font::{Typeface, fit};
use crate::report::plots::legend::{self, Entry};
use crate::report::plots::sheet::Align;
use crate::report::plots::style::{DARK, GREY, Style};
use crate::report::plots::{self, Axis, Panel, Sheet};
use crate::report::rows::table as csv;
use crate::report::{Artifact, ReportError};

/// The folder below the results.
const FOLDER: &str = "stress";

/// The tables for the screen.
#[must_use]
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
    let mut estimators: Vec<&str> = curves.iter().map(|curve| curve.estimator).collect();
    let shown = estimators.len() / Along::ALL.len();
    estimators.truncate(shown);
    let of = |along: Along| -> Vec<Field> {
        let curves = curves.iter().filter(|curve| curve.along == along);
        let words = curves.map(|curve| {
            let nowhere = || match curve.holds_to() {
                Some(x) => format!("> {}", short(x, 3)),
                None => "not resolved".to_owned(),
            };
            curve.fails_from().map_or_else(nowhere, |x| short(x, 3))
        });
        words.map(Field::plain).collect()
    };
    let names = estimators.iter().map(|name| Field::plain((*name).to_owned())).collect();
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

#[derive(Serialize)]
struct JsonRow<'a> {
    quantity: &'a str,
    range: &'a str,
    trials: u64,
    skipped: u64,
    measure: &'static str,
    worst: Option<f64>,
    bound: f64,
    place: &'a str,
    holds: bool,
}

#[derive(Serialize)]
struct JsonPoint {
    x: f64,
    walks: f64,
    bias: f64,
    error: f64,
    noise: Option<f64>,
    exceeds: bool,
}

#[derive(Serialize)]
struct JsonCurve {
    estimator: &'static str,
    along: &'static str,
    fails_from: Option<f64>,
    points: Vec<JsonPoint>,
}

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    holds: bool,
    rows: Vec<JsonRow<'a>>,
    single_precision: Vec<JsonCurve>,
}

/// A number that JSON knows.
fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

fn json(found: &Stress) -> Result<String, ReportError> {
    let rows = found.rows.iter().map(|row| JsonRow {
        quantity: &row.quantity,
        range: &row.range,
        trials: row.trials,
        skipped: row.skipped,
        measure: row.measure.words(),
        worst: finite(row.worst),
        bound: row.bound,
        place: &row.place,
        holds: row.holds(),
    });
    let curves = found.narrow.curves.iter().map(|curve| JsonCurve {
        estimator: curve.estimator,
        along: curve.along.word(),
        fails_from: curve.fails_from(),
        points: curve
            .points
            .iter()
            .map(|point| JsonPoint {
                x: point.x,
                walks: point.walks,
                bias: point.bias,
                error: point.error,
                noise: finite(point.noise),
                exceeds: point.exceeds(),
            })
            .collect(),
    });
    let document = Document {
        schema: 1,
        holds: found.holds(),
        rows: rows.collect(),
        single_precision: curves.collect(),
    };
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

/// The tables as CSV and JSON and the plot of single precision, all below `stress/`.
///
/// # Errors
///
/// Where an encoder or the painter gives up.
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
    let header = ["estimator", "along", "x", "walks", "bias", "bias_error", "noise_1e8", "exceeds"];
    let narrow = csv("single precision", header, points)?;
    let artifact = |name: &str, text: String| Artifact {
        path: format!("{FOLDER}/{name}").into(),
        bytes: text.into_bytes(),
    };
    let mut all = vec![
        artifact("stress.csv", stress),
        artifact("stress.json", json(found)?),
        artifact("single-precision.csv", narrow),
    ];
    let sheet = figure(&found.narrow.curves)?;
    all.extend(plots::artifacts(&format!("{FOLDER}/single-precision"), "", &sheet)?);
    Ok(all)
}

const LEFT: f64 = 84.0;
const TOP: f64 = 92.0;
const PANEL: [f64; 2] = [400.0, 380.0];
const PITCH: f64 = 494.0;

/// Bias over noise of every estimator along every quantity: above 1 single precision is wrong.
fn figure(curves: &[Curve]) -> Result<Sheet, ReportError> {
    let face = Typeface::load().map_err(|error| ReportError::Draw {
        figure: "single precision".to_owned(),
        message: error.to_string(),
    })?;
    let width = LEFT + 3.0 * PITCH - 64.0;
    let names: Vec<&str> = curves
        .iter()
        .filter(|curve| curve.along == Along::Steps)
        .map(|curve| curve.estimator)
        .collect();
    let entries: Vec<Entry> = names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let Style { colour, dash, marker } = Style::of(i);
            Entry {
                label: (*name).to_owned(),
                line: Some((dash, 2.0)),
                marker: Some(marker),
                colour,
            }
        })
        .collect();
    let below = TOP + PANEL[1] + 78.0;
    let span = width - LEFT - 18.0;
    let legend = legend::height(&face, &entries, span);
    let mut sheet = Sheet::new(width, below + legend + 16.0);
    let title = "Single precision: its bias beside the statistical error of 1e8 draws";
    let words = "Points: |mean of X₂₄ − X₅₃|/T over √(V/1e8)/T, from the same random words; bars: two \
                 standard errors of the bias. Above 1, rounding outgrows the noise.";
    for (y, text, size, colour) in [(30.0, title, 20.0, DARK), (57.0, words, 13.0, GREY)] {
        sheet.text([LEFT, y], fit(&face, text, size, span), size, colour, Align::Start);
    }
    for (place, along) in Along::ALL.into_iter().enumerate() {
        let shown: Vec<&Curve> = curves.iter().filter(|curve| curve.along == along).collect();
        one_panel(&mut sheet, place, along, &shown);
    }
    legend::draw(&face, &mut sheet, [LEFT, below - 8.0], &entries, span);
    Ok(sheet)
}

/// What is drawn of a point: below a thousandth the bias is nothing.
const FLOOR: f64 = 1e-3;

fn one_panel(sheet: &mut Sheet, place: usize, along: Along, curves: &[&Curve]) {
    // Without a variance there is no noise to compare with.
    let has_noise = |point: &&Point| point.noise.is_finite();
    let points = || curves.iter().flat_map(|curve| &curve.points).filter(has_noise);
    let share = |bias: f64, noise: f64| (bias.abs() / noise).max(FLOOR);
    let x = Axis::around(along.title(), true, 0.04, points().map(|point| point.x));
    let shares = points().map(|point| share(point.bias, point.noise)).filter(|y| y.is_finite());
    let y = Axis::around("bias / noise", true, 0.04, shares.chain([FLOOR, 10.0]));
    let left = LEFT + place as f64 * PITCH;
    let panel = Panel { left, top: TOP, right: left + PANEL[0], bottom: TOP + PANEL[1], x, y };
    panel.grid(sheet);
    let edges = [panel.x.low, panel.x.high].map(|x| (x, 1.0));
    panel.line(sheet, edges, (&[], 1.6, GREY));
    for (i, curve) in curves.iter().enumerate() {
        let Style { colour, dash, marker } = Style::of(i);
        let shown = || curve.points.iter().filter(has_noise);
        let line = shown().map(|point| (point.x, share(point.bias, point.noise)));
        panel.line(sheet, line, (dash, 1.6, colour));
        for point in shown() {
            let Some(spot) = panel.spot(point.x, share(point.bias, point.noise)) else { continue };
            let [low, high] = [-2.0, 2.0].map(|z| (point.bias.abs() + z * point.error).max(0.0));
            let ends = (share(low, point.noise), share(high, point.noise));
            panel.bar(sheet, spot[0], ends, (3.0, 1.0, colour.mix(0.5)));
            panel.point(sheet, spot, marker, 4.0, colour);
        }
    }
    let heads = ["(a) τ = 2", "(b) σ\u{302} = 20 max σₜ", "(c) τ = 2, 40 collisions"];
    panel.frame(sheet, heads[place]);
}

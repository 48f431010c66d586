//! Single precision as a plot: a row of panels for each family of estimators, a column for each quantity.

use plotters::style::Color;

use crate::report::ReportError;
use crate::report::plots::font::{Typeface, fit};
use crate::report::plots::legend::{self, Entry, LINE};
use crate::report::plots::sheet::Align;
use crate::report::plots::style::{DARK, GREY, Style};
use crate::report::plots::{Axis, Panel, Sheet};
use crate::stress::narrow::{Along, Curve, Point};

const LEFT: f64 = 84.0;
const TOP: f64 = 132.0;
const PANEL: [f64; 2] = [400.0, 250.0];
const PITCH: [f64; 2] = [494.0, 350.0];
/// The width of legends beside a row, and what keeps them off the last panel.
const LEGEND: [f64; 2] = [310.0, 26.0];

/// Bias over noise of every estimator along every quantity: above 1 single precision is wrong.
///
/// # Errors
///
/// Where there is no typeface.
pub fn figure(curves: &[Curve]) -> Result<Sheet, ReportError> {
    let face = Typeface::load().map_err(|error| ReportError::Draw {
        figure: "single precision".to_owned(),
        message: error.to_string(),
    })?;
    let mut families: Vec<&str> = curves.iter().map(|curve| curve.family).collect();
    families.dedup();
    let beside = LEFT + 2.0 * PITCH[0] + PANEL[0] + LEGEND[1];
    let height = TOP + families.len() as f64 * PITCH[1];
    let mut sheet = Sheet::new(beside + LEGEND[0], height);
    let title = "Single precision: its bias beside the statistical error of 1e8 draws";
    let words = "Points: |mean of X₂₄ − X₅₃|/E[X] over √(V/1e8)/E[X], from the same random words; bars: two \
                 standard errors of the bias. Above 1, rounding outgrows the noise.";
    let more =
        "Pale points: the walks were too few to tell. Below 0.001 the bias is drawn as nothing.";
    let span = beside + LEGEND[0] - LEFT - 18.0;
    let lines = [(30.0, title, 20.0, DARK), (57.0, words, 13.0, GREY), (77.0, more, 13.0, GREY)];
    for (y, text, size, colour) in lines {
        sheet.text([LEFT, y], fit(&face, text, size, span), size, colour, Align::Start);
    }
    for (row, family) in families.into_iter().enumerate() {
        let top = TOP + row as f64 * PITCH[1];
        let of = |along: Along| -> Vec<&Curve> {
            curves.iter().filter(|c| c.family == family && c.along == along).collect()
        };
        for (column, along) in Along::ALL.into_iter().enumerate() {
            let left = LEFT + column as f64 * PITCH[0];
            let head = format!(
                "{family}: {}",
                ["τ = 2", "σ\u{302} = 20 max σₜ", "τ = 2, 40 collisions"][column]
            );
            one_panel(&mut sheet, [left, top], (&head, along), &of(along));
        }
        let shown = of(Along::Steps);
        let entries: Vec<Entry> = shown.iter().enumerate().map(entry).collect();
        let place = [beside, top + 0.5 * LINE];
        legend::draw(&face, &mut sheet, place, &entries, LEGEND[0] - 8.0);
    }
    Ok(sheet)
}

fn entry((index, curve): (usize, &&Curve)) -> Entry {
    let Style { colour, marker, .. } = Style::of(index);
    let label = curve.estimator.to_owned();
    Entry { label, line: Some((&[], 2.0)), marker: Some(marker), colour }
}

/// What is drawn of a point: below a thousandth the bias is nothing.
const FLOOR: f64 = 1e-3;

fn one_panel(
    sheet: &mut Sheet,
    [left, top]: [f64; 2],
    (head, along): (&str, Along),
    curves: &[&Curve],
) {
    // Without a variance there is no noise to compare with.
    let has_noise = |point: &&Point| point.noise > 0.0;
    let points = || curves.iter().flat_map(|curve| &curve.points).filter(has_noise);
    let share = |bias: f64, noise: f64| (bias.abs() / noise).max(FLOOR);
    let x = Axis::around(along.title(), true, 0.04, points().map(|point| point.x));
    let shares = points().map(|point| share(point.bias, point.noise)).filter(|y| y.is_finite());
    let y = Axis::around("bias / noise", true, 0.04, shares.chain([FLOOR, 10.0]));
    let panel = Panel { left, top, right: left + PANEL[0], bottom: top + PANEL[1], x, y };
    panel.grid(sheet);
    let edges = [panel.x.low, panel.x.high].map(|x| (x, 1.0));
    panel.line(sheet, edges, (&[], 1.6, GREY));
    for (i, curve) in curves.iter().enumerate() {
        // Markers tell the curves apart; dashes would be most of the file.
        let Style { colour, marker, .. } = Style::of(i);
        let shown = || curve.points.iter().filter(has_noise);
        let line = shown().map(|point| (point.x, share(point.bias, point.noise)));
        panel.line(sheet, line, (&[], 1.4, colour.mix(0.6)));
        for point in shown() {
            let Some(spot) = panel.spot(point.x, share(point.bias, point.noise)) else { continue };
            let is_told = point.exceeds() || point.holds();
            let colour = if is_told { colour } else { colour.mix(0.3) };
            let [low, high] = [-2.0, 2.0].map(|z| (point.bias.abs() + z * point.error).max(0.0));
            let ends = (share(low, point.noise), share(high, point.noise));
            panel.bar(sheet, spot[0], ends, (3.0, 1.0, colour.mix(0.5)));
            panel.point(sheet, spot, marker, 4.0, colour);
        }
    }
    panel.frame(sheet, head);
}

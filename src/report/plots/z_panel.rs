//! Panel of z-scores: deviations of means, variances and lookups from theory.

use plotters::style::RGBAColor;

use crate::record::{Score, Sweep};
use crate::report::plots::legend::{self, MarkerKey};
use crate::report::plots::overlap::smallest_step;
use crate::report::plots::series::Series;
use crate::report::plots::style::{GREY, Marker, PAPER, ink};
use crate::report::plots::{Axis, Panel};
use drawing::Sheet;
use drawing::font::Typeface;
use numeric::digits::{short, signed};

/// Limit of |z| within which 95 % of the scores of a correct estimator lie.
const USUAL: f64 = 1.96;
/// Radius of a marker, and width of the largest one with its rim.
const RADIUS: f64 = 3.6;
const MARKER: f64 = 10.0;
const BAND: RGBAColor = ink(0xEE, 0xF3, 0xF7);
const LIMIT: RGBAColor = ink(0xB0, 0x30, 0x30);

/// Scores, each with its marker.
const SCORES: [(Score, Marker); 3] = [
    (Score::Mean, Marker::Disc),
    (Score::Variance, Marker::Square),
    (Score::Lookups, Marker::Diamond),
];

/// Draws the scores of the series into a panel, and chooses its vertical axis.
pub fn draw(
    face: &Typeface,
    sheet: &mut Sheet,
    mut panel: Panel,
    series: &[Series],
    sweep: &Sweep,
) {
    let rows = series.iter().flat_map(|one| &one.rows);
    let scores = rows.flat_map(|row| Score::ALL.map(|score| row.compared(score).z));
    let largest = scores.flatten().map(f64::abs).filter(|z| z.is_finite()).fold(0.0, f64::max);
    // Far outliers of a failed check would flatten all other scores: they become arrows at the edge.
    let usual = 1.3 * sweep.z_limit.unwrap_or(3.0).max(USUAL);
    let edge = (1.1 * largest).clamp(usual, 2.0 * usual);
    let title = "z, in standard errors".to_owned();
    panel.y = Axis { title, log: false, low: -edge, high: edge };
    let ends = [panel.x.low, panel.x.high];
    panel.band(sheet, ends.map(|x| (x, -USUAL, USUAL)), BAND);
    panel.grid(sheet);
    panel.line(sheet, ends.map(|x| (x, 0.0)), (&[], 1.0, GREY));
    for limit in sweep.z_limit.into_iter().flat_map(|z| [-z, z]) {
        panel.line(sheet, ends.map(|x| (x, limit)), (&[8.0, 4.0], 1.3, LIMIT));
    }
    let beyond = points(sheet, &panel, series);
    panel.frame(sheet, "(d) Agreement with theory");
    let key = |marker, words| MarkerKey { marker, is_hollow: false, words };
    let mut keys: Vec<MarkerKey> =
        SCORES.map(|(score, marker)| key(marker, score.quantity())).into();
    if beyond {
        keys.push(key(Marker::Up, "beyond"));
    }
    let [right, top] = [panel.right, panel.top];
    legend::keys(face, sheet, [right, top - 15.0], &keys);
}

/// Returns the meaning of the band and the dashes, in words.
pub fn note(sweep: &Sweep) -> String {
    let band = format!("(d): 95 % of the scores of a correct estimator lie in the band, ±{USUAL}");
    let limit =
        sweep.z_limit.map(|z| format!("; the dashes, ±{}, are the level of the gate", short(z, 3)));
    band + &limit.unwrap_or_default()
}

/// Returns the meaning of hollow points, if there are any.
pub fn legend_of_hollow(series: &[Series]) -> Option<String> {
    let any = series.iter().flat_map(|one| &one.rows).any(|row| !row.not_normal.is_empty());
    any.then(|| "(d), hollow: too few draws for a normal approximation".to_owned())
}

/// Draws the points side by side, so that none hides another; returns whether any is off the axis.
fn points(sheet: &mut Sheet, panel: &Panel, series: &[Series]) -> bool {
    let swept = series.iter().filter(|one| !one.is_fixed()).count();
    let slots = (swept * SCORES.len()) as f64;
    let rows = || series.iter().flat_map(|one| &one.rows);
    let places = rows().filter_map(|row| panel.across(row.experiment.swept()?));
    let step = (0.7 * smallest_step(places).min(120.0) / slots.max(1.0)).min(MARKER);
    // Points of a value at the edge of the sweep stay side by side within the panel.
    let reach = 4.0 + (slots - 1.0).max(0.0) / 2.0 * step;
    let (minimum, maximum) = (panel.left + reach, (panel.right - reach).max(panel.left + reach));
    let mut beyond = false;
    let (mut slot, mut edge) = (0.0, panel.right - 9.0);
    for one in series {
        let fixed = one.is_fixed();
        for (score, marker) in SCORES {
            let shift = (slot - (slots - 1.0) / 2.0) * step;
            slot += if fixed { 0.0 } else { 1.0 };
            for row in &one.rows {
                // Estimators that are not swept have a place at the right edge, as in other panels.
                let place = row.experiment.swept().map_or(Some(edge), |swept| {
                    Some(panel.across(swept)?.clamp(minimum, maximum) + shift)
                });
                let (Some(x), Some(z)) = (place, row.compared(score).z) else { continue };
                // An infinite score has no place on the axis, and counts as beyond it.
                let Some(y) = panel.down(z.clamp(-1e9, 1e9)) else { continue };
                let at = [x.clamp(panel.left + 4.0, panel.right - 4.0), y];
                if panel.holds(at) {
                    let what = score.quantity();
                    sheet.tip(at, format!("{}: z of the {what} {}", row.name(), signed(z)));
                    panel.point(sheet, at, marker, RADIUS, one.style.colour);
                    if !row.is_normal(score) {
                        panel.point(sheet, at, marker, 0.8, PAPER);
                    }
                    continue;
                }
                beyond = true;
                let (arrow, y) = if z > 0.0 {
                    (Marker::Up, panel.top + 7.0)
                } else {
                    (Marker::Down, panel.bottom - 7.0)
                };
                panel.point(sheet, [at[0], y], arrow, 4.6, one.style.colour);
            }
        }
        if fixed {
            edge -= 13.0;
        }
    }
    beyond
}

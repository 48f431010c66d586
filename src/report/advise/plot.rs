//! `advise.svg` and `advise.png`: time to the error against σ̂, and σ̂ along the ray.

use crate::advise::profile::SamplingProfile;
use crate::advise::{Advice, Row, Target};
use crate::report::ReportError;
use crate::report::plots::figure::{Figure, Foot, LEFT};
use crate::report::plots::legend::LegendEntry;
use crate::report::plots::style::{COLOURS, DARK, Style};
use crate::report::plots::{Axis, Panel};
use drawing::Sheet;
use numeric::digits::{counted, number, short};

const WIDTH: f64 = 1200.0;
const TOP: f64 = 104.0;
const PANEL: [f64; 2] = [490.0, 400.0];
const PITCH: f64 = 600.0;
/// Number of estimators that are shown.
const SHOWN: usize = 5;
/// Range of the costs that are shown, relative to the least.
const RANGE: f64 = 100.0;

/// Returns the figure.
pub fn figure(advice: &Advice) -> Result<Sheet, ReportError> {
    let rows: Vec<&Row> =
        advice.rows.iter().filter(|row| !row.curve.is_empty()).take(SHOWN).collect();
    let mut entries: Vec<LegendEntry> =
        rows.iter().enumerate().map(|(i, row)| entry(row, i)).collect();
    let profile = advice.profiles.first();
    if let Some(profile) = profile {
        let line = |label: &str, colour| LegendEntry {
            label: label.to_owned(),
            line: Some((&[], 2.0)),
            marker: None,
            colour,
        };
        entries.push(line(&format!("(b) {}|σₜ − σ_c|", scale(profile).1), DARK));
        entries.push(line(&format!("(b) best σ\u{302}(t), {}", profile.estimator), COLOURS[1]));
    }
    let notes = vec![
        "Markers: the best σ\u{302} of each estimator. A line ends where the estimator is refused."
            .to_owned(),
    ];
    let foot = Foot { top: TOP + PANEL[1] + 84.0, entries: &entries, notes: &notes };
    let rays = counted(advice.rays as u64, "ray");
    let facts = format!("{}  ·  {}  ·  {rays}", advice.case, advice.medium);
    let mut figure = Figure::with_foot(&advice.case, WIDTH, [&advice.title, &facts], &foot)?;
    costs(&mut figure.sheet, advice, &rows);
    if profile.is_some() {
        along(&mut figure.sheet, advice);
    }
    Ok(figure.close(&foot))
}

fn entry(row: &Row, index: usize) -> LegendEntry {
    let Style { colour, dash, marker } = Style::of(index);
    let control = if row.control.is_empty() { String::new() } else { format!(", {}", row.control) };
    let best = row.constant.map(|x| format!(", σ\u{302} = {}", short(x, 4))).unwrap_or_default();
    let label = format!("{}{control}{best}", row.estimator);
    LegendEntry { label, line: Some((dash, 2.0)), marker: Some(marker), colour }
}

/// Draws the costs against σ̂.
fn costs(sheet: &mut Sheet, advice: &Advice, rows: &[&Row]) {
    let points = || rows.iter().flat_map(|row| row.curve.iter().copied());
    let minimum = points().map(|[_, y]| y).fold(f64::INFINITY, f64::min);
    let shown = || points().filter(|[_, y]| *y <= RANGE * minimum);
    let title = match (advice.target, advice.unit()) {
        (Target::Error(error), unit) => format!("cost to {} [{unit}]", short(error, 3)),
        (Target::Budget(_), _) => "relative error".to_owned(),
    };
    let x = Axis::around("σ\u{302} [1/length]", true, 0.04, shown().map(|[x, _]| x));
    let y = Axis::around(title, true, 0.04, shown().map(|[_, y]| y));
    let panel = Panel::at([LEFT, TOP], PANEL, x, y);
    panel.grid(sheet);
    for (index, row) in rows.iter().enumerate() {
        let Style { colour, dash, marker } = Style::of(index);
        panel.line(sheet, row.curve.iter().map(|&[x, y]| (x, y)), (dash, 2.0, colour));
        let goal = if let Target::Error(_) = advice.target { row.time } else { row.error };
        if let Some(spot) = row.constant.and_then(|x| panel.spot(x, goal)) {
            panel.point(sheet, spot, marker, 6.0, colour);
        }
    }
    panel.frame(sheet, "(a) Cost against a constant σ\u{302}");
}

/// Returns the power of ten, and its words, by which the residual is as high as the best σ̂ at most.
fn scale(profile: &SamplingProfile) -> (f64, String) {
    let maximum = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let residual = maximum(&mut profile.residual.iter().map(|point| point[1]));
    let ratio = maximum(&mut profile.values.iter().copied()) / residual;
    let scale = 10_f64.powf(ratio.log10().floor().clamp(0.0, 300.0));
    let is_used = scale.is_finite() && scale > 1.0;
    if is_used { (scale, format!("{} × ", number(scale))) } else { (1.0, String::new()) }
}

/// Draws the first profile along the ray.
fn along(sheet: &mut Sheet, advice: &Advice) {
    let Some(profile) = advice.profiles.first() else { return };
    let steps = || profile.breaks.windows(2).zip(&profile.values);
    let sampling: Vec<(f64, f64)> = steps().flat_map(|(t, &y)| [(t[0], y), (t[1], y)]).collect();
    let (scale, _) = scale(profile);
    let residual = profile.residual.iter().map(|&[t, y]| (t, scale * y));
    let x = Axis::around("t [length]", false, 0.02, profile.breaks.iter().copied());
    let heights = sampling.iter().map(|point| point.1).chain(residual.clone().map(|point| point.1));
    let y = Axis::around("extinction [1/length]", false, 0.04, heights.chain([0.0]));
    let panel = Panel::at([LEFT + PITCH, TOP], PANEL, x, y);
    panel.grid(sheet);
    panel.line(sheet, residual, (&[], 1.6, DARK));
    panel.line(sheet, sampling, (&[], 2.0, COLOURS[1]));
    panel.frame(sheet, "(b) The best σ\u{302} along the ray");
}

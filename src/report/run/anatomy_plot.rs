//! `CASE.anatomy.svg` and `.png`: a ray seen from the side, with the extinctions of an estimator above and its
//! transmittance below.
//!
//! After Figures 5 and 8 of L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády,
//! "Unbiased Light Transport Estimators for Inhomogeneous Participating Media", Computer Graphics
//! Forum 36(2), 2017.

use plotters::style::{Color, RGBAColor};

use crate::record::{Anatomy, CaseRecord, Record};
use crate::report::plots::figure::{Figure, LEFT, subject};
use crate::report::plots::legend::{self, LegendEntry};
use crate::report::plots::style::{COLOURS, DARK, GREY, Marker};
use crate::report::plots::{self, Axis, Panel};
use crate::report::{Artifact, ReportError};
use drawing::Sheet;
use numeric::digits::short;

const RIGHT: f64 = 940.0;
const LEGEND: f64 = 968.0;

/// Returns two panels for each case with a curve.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let mut artifacts = Vec::new();
    for case in &record.results.cases {
        if let Some(anatomy) = &case.anatomy {
            let sheet = figure(case, anatomy)?;
            artifacts.extend(plots::artifacts(&case.name, "anatomy.", &sheet)?);
        }
    }
    Ok(artifacts)
}

/// Returns the figure of a case with a curve.
pub fn figure(case: &CaseRecord, anatomy: &Anatomy) -> Result<Sheet, ReportError> {
    let label = anatomy.experiment.label();
    let words = [subject(&case.name, &case.medium), label].join("  ·  ");
    let size = [1200.0, 900.0];
    let Figure { face, mut sheet, .. } =
        Figure::new(&case.name, size, 1090.0, [&case.title, &words])?;
    let upper = medium(&mut sheet, anatomy);
    legend::draw(&face, &mut sheet, [LEGEND, 116.0], &upper, 220.0);
    let lower = transmittance(&mut sheet, anatomy);
    legend::draw(&face, &mut sheet, [LEGEND, 518.0], &lower, 220.0);
    Ok(sheet)
}

fn panel(anatomy: &Anatomy, [top, bottom]: [f64; 2], y: Axis) -> Panel {
    let x = Axis::around("distance t along the ray [length]", false, 0.015, anatomy.t.clone());
    Panel { left: LEFT, top, right: RIGHT, bottom, x, y }
}

/// Curve of the upper panel: name, values, dashes, width, colour.
type AnatomyCurve<'a> = (&'static str, &'a [f64], &'static [f64], f64, RGBAColor);

/// Draws the upper panel: extinctions, explorer points, and collisions of the first walk.
fn medium(sheet: &mut Sheet, anatomy: &Anatomy) -> Vec<LegendEntry> {
    let profiles: [AnatomyCurve; 4] = [
        ("sampling σ\u{302}", &anatomy.sampling, &[9.0, 4.0], 2.0, COLOURS[2]),
        ("control", &anatomy.control, &[], 2.0, COLOURS[0]),
        ("residual", &anatomy.residual, &[2.5, 3.0], 2.0, COLOURS[1]),
        ("extinction σₜ", &anatomy.extinction, &[], 2.4, DARK),
    ];
    let dots = anatomy.explorers.iter().chain(&anatomy.collisions).map(|dot| dot[1]);
    let values = profiles.iter().flat_map(|profile| profile.1).copied().chain(dots);
    let y = Axis::around("extinction [1/length]", false, 0.06, values.chain([0.0]));
    let panel = panel(anatomy, [104.0, 420.0], y);
    panel.grid(sheet);
    panel.line(sheet, [panel.x.low, panel.x.high].map(|x| (x, 0.0)), (&[], 1.0, GREY));
    let mut entries = Vec::new();
    for (name, values, dash, width, colour) in profiles.into_iter().filter(|p| !p.1.is_empty()) {
        let points = anatomy.t.iter().copied().zip(values.iter().copied());
        panel.line(sheet, points, (dash, width, colour));
        let (label, line) = (name.to_owned(), Some((dash, width)));
        entries.insert(0, LegendEntry { label, line, marker: None, colour });
    }
    let dots = [
        ("explorer point", &anatomy.explorers, Marker::Diamond, 5.0, COLOURS[0]),
        ("tentative collision", &anatomy.collisions, Marker::Disc, 4.2, COLOURS[3]),
    ];
    for (name, dots, marker, size, colour) in dots.into_iter().filter(|dots| !dots.1.is_empty()) {
        for &[t, value] in dots {
            if marker == Marker::Disc {
                panel.line(sheet, [(t, 0.0), (t, value)], (&[], 1.0, colour));
            }
            if let Some(spot) = panel.spot(t, value) {
                panel.point(sheet, spot, marker, size, colour);
                let [t, value] = [t, value].map(|value| short(value, 4));
                sheet.tip(spot, format!("{name} at t = {t}: {value} per length"));
            }
        }
        entries.push(LegendEntry {
            label: name.to_owned(),
            line: None,
            marker: Some(marker),
            colour,
        });
    }
    panel.frame(sheet, "(a) The medium, and the collisions of one flight");
    entries
}

/// Draws the lower panel: the exact transmittance, the spread of draws about it, and the measured means.
fn transmittance(sheet: &mut Sheet, anatomy: &Anatomy) -> Vec<LegendEntry> {
    let panel = panel(anatomy, [506.0, 822.0], transmittance_axis(anatomy));
    let blue = COLOURS[6];
    panel.band(sheet, spread(anatomy), blue.mix(0.22));
    panel.grid(sheet);
    panel.line(sheet, [panel.x.low, panel.x.high].map(|x| (x, 0.0)), (&[], 1.0, GREY));
    for walk in &anatomy.walks {
        let points = anatomy.t.iter().copied().zip(walk.iter().copied());
        panel.line(sheet, points, (&[], 1.0, COLOURS[2].mix(0.75)));
    }
    let exact = anatomy.t.iter().copied().zip(anatomy.transmittance.iter().copied());
    panel.line(sheet, exact, (&[], 2.4, DARK));
    let red = COLOURS[1];
    for point in &anatomy.measured {
        let Some(spot) = panel.spot(point.t, point.mean) else { continue };
        for (deviation, cap, width) in
            [(point.deviation, 6.0, 1.2), (point.standard_error, 3.5, 2.8)]
        {
            let ends = [point.mean - deviation, point.mean, point.mean + deviation];
            panel.bar(sheet, spot[0], ends, (cap, width, red));
        }
        panel.point(sheet, spot, Marker::Disc, 4.6, red);
        let [t, mean, error] = [point.t, point.mean, point.standard_error].map(|x| short(x, 4));
        sheet.tip(spot, format!("mean of draws at t = {t}: {mean} ± {error}"));
    }
    panel.frame(sheet, "(b) The transmittance and its estimates");
    let entry = |label: &str, line, marker, colour| {
        let label = label.to_owned();
        LegendEntry { label, line, marker, colour }
    };
    let solid = |width| Some((&[] as &[f64], width));
    let mut entries = vec![
        entry("exact T(t)", solid(2.4), None, DARK),
        entry("± 1 deviation in theory", solid(12.0), None, blue.mix(0.22)),
    ];
    if !anatomy.walks.is_empty() {
        entries.push(entry("single draws", solid(1.0), None, COLOURS[2].mix(0.75)));
    }
    if !anatomy.measured.is_empty() {
        entries.push(entry("mean of draws", None, Some(Marker::Disc), red));
        entries.push(entry("± 1 standard error", solid(2.8), None, red));
        entries.push(entry("± 1 deviation measured", solid(1.2), None, red));
    }
    entries
}

/// Returns the band of one standard deviation: (t, low, high).
fn spread(anatomy: &Anatomy) -> impl Iterator<Item = (f64, f64, f64)> {
    let curve = anatomy.t.iter().zip(&anatomy.transmittance).zip(&anatomy.deviation);
    curve.map(|((&t, &mean), &deviation)| (t, mean - deviation, mean + deviation))
}

/// Returns a range with the curve and the means. Spread and walks may at most double it to either side, for a single
/// extreme draw would flatten everything else.
fn transmittance_axis(anatomy: &Anatomy) -> Axis {
    let means = anatomy.measured.iter().map(|point| point.mean);
    let core = means.chain(anatomy.transmittance.iter().copied()).chain([0.0]);
    let (low, high) = core
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let span = (high - low).max(1e-300);
    let bands = spread(anatomy).flat_map(|(_, l, h)| [l, h]);
    let walks = anatomy.walks.iter().flatten().copied();
    let wide = bands.chain(walks).filter(|value| !value.is_nan());
    let shown = wide.map(|value| value.clamp(low - 0.6 * span, high + 0.6 * span));
    Axis::around("transmittance T", false, 0.04, shown.chain([low, high]))
}

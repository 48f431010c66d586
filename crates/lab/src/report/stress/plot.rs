//! Single precision as a plot: a panel for each quantity that is varied, with the estimator of each family that is the
//! first to have a bias above the noise.

use plotters::style::Color;

use crate::stress::narrow::{Along, BothPrecisions, PrecisionCurve};
use drawing::Sheet;
use drawing::font::fit;
use drawing::sheet::Align;
use trueflight::report::ReportError;
use trueflight::report::plots::figure::{Figure, LEFT};
use trueflight::report::plots::legend::{self, LINE, LegendEntry};
use trueflight::report::plots::style::{GREY, Style};
use trueflight::report::plots::{Axis, Panel};

const TOP: f64 = 138.0;
const PANEL: [f64; 2] = [400.0, 300.0];
const PITCH: f64 = 494.0;
/// Distance from the bottom of a panel to its legend.
const BELOW: f64 = 76.0;
/// Smallest ratio that is drawn: a bias below a thousandth of the noise does not matter.
const FLOOR: f64 = 1e-3;

/// Draws bias over noise along every quantity: above 1 single precision is wrong.
pub fn figure(curves: &[PrecisionCurve]) -> Result<Sheet, ReportError> {
    let mut families: Vec<&str> = curves.iter().map(|curve| curve.family).collect();
    families.dedup();
    let panels = Along::ALL.map(|along| first_to_fail(curves, &families, along));
    let maximum = panels.iter().map(Vec::len).max().unwrap_or(0);
    let width = LEFT + 2.0 * PITCH + PANEL[0] + 26.0;
    let size = [width, TOP + PANEL[1] + BELOW + (maximum as f64 + 0.5) * LINE];
    let title = "Single precision: its bias beside the statistical error of 1e8 draws";
    let points = "Points: |mean of X₂₄ − X₅₃|/E[X] over √(V/1e8)/E[X], from the same random words; bars: two standard errors of \
                  the bias. Above 1, rounding outgrows the noise.";
    let families_shown = "Of each family the estimator that fails first; a family without a curve is not seen to fail. Pale points: \
                          the walks were too few to tell. Below 0.001 the bias is drawn as nothing.";
    let span = width - LEFT - 18.0;
    let Figure { face, mut sheet, .. } =
        Figure::new("single precision", size, span, [title, points])?;
    let words = fit(&face, families_shown, 13.0, span);
    sheet.text([LEFT, 77.0], words, 13.0, GREY, Align::Start);
    for (column, (along, shown)) in Along::ALL.into_iter().zip(&panels).enumerate() {
        let left = LEFT + column as f64 * PITCH;
        let all = curves.iter().filter(|curve| curve.along == along);
        one_panel(&mut sheet, left, along, (shown, all.flat_map(|curve| &curve.points)));
        let entries: Vec<LegendEntry> = shown.iter().map(entry).collect();
        legend::draw(&face, &mut sheet, [left, TOP + PANEL[1] + BELOW], &entries, PANEL[0]);
    }
    Ok(sheet)
}

/// Returns for each family, with its number, the curve that exceeds the noise at the smallest value; of several such
/// curves the one with the largest bias there. Families without such a curve are left out.
fn first_to_fail<'a>(
    curves: &'a [PrecisionCurve],
    families: &[&str],
    along: Along,
) -> Vec<(usize, &'a PrecisionCurve)> {
    let key = |curve: &PrecisionCurve| {
        let point = curve.points.iter().find(|point| point.exceeds())?;
        Some([point.x, -share(point.bias, point.noise)])
    };
    let first = |(number, family): (usize, &&str)| {
        let of_family = curves.iter().filter(|c| c.family == *family && c.along == along);
        let failing = of_family.filter_map(|curve| Some((key(curve)?, curve)));
        let first =
            failing.min_by(|(a, _), (b, _)| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
        first.map(|(_, curve)| (number, curve))
    };
    families.iter().enumerate().filter_map(first).collect()
}

fn entry(&(family, curve): &(usize, &PrecisionCurve)) -> LegendEntry {
    let Style { colour, marker, .. } = Style::of(family);
    let label = curve.estimator.to_owned();
    LegendEntry { label, line: Some((&[], 2.0)), marker: Some(marker), colour }
}

fn share(bias: f64, noise: f64) -> f64 {
    (bias.abs() / noise).max(FLOOR)
}

/// Without a variance there is no noise to compare with.
#[allow(clippy::trivially_copy_pass_by_ref)] // what filters hand over
fn has_noise(point: &&BothPrecisions) -> bool {
    point.noise > 0.0
}

fn one_panel<'a>(
    sheet: &mut Sheet,
    left: f64,
    along: Along,
    (curves, all): (&[(usize, &PrecisionCurve)], impl Iterator<Item = &'a BothPrecisions>),
) {
    let points = || curves.iter().flat_map(|(_, curve)| &curve.points).filter(has_noise);
    let x = Axis::around(along.title(), true, 0.04, all.map(|point| point.x));
    let shares = points().map(|point| share(point.bias, point.noise)).filter(|y| y.is_finite());
    let y = Axis::around("bias / noise", true, 0.04, shares.chain([FLOOR, 10.0]));
    let panel = Panel::at([left, TOP], PANEL, x, y);
    panel.grid(sheet);
    let edges = [panel.x.low, panel.x.high].map(|x| (x, 1.0));
    panel.line(sheet, edges, (&[], 1.6, GREY));
    for &(family, curve) in curves {
        let Style { colour, marker, .. } = Style::of(family);
        let shown = || curve.points.iter().filter(has_noise);
        let line = shown().map(|point| (point.x, share(point.bias, point.noise)));
        panel.line(sheet, line, (&[], 1.4, colour.mix(0.6)));
        for point in shown() {
            let Some(spot) = panel.spot(point.x, share(point.bias, point.noise)) else { continue };
            let is_told = point.exceeds() || point.holds();
            let colour = if is_told { colour } else { colour.mix(0.3) };
            let [low, high] = [-2.0, 2.0].map(|z| (point.bias.abs() + z * point.error).max(0.0));
            let ends =
                [share(low, point.noise), share(point.bias, point.noise), share(high, point.noise)];
            panel.bar(sheet, spot[0], ends, (3.0, 1.0, colour.mix(0.5)));
            panel.point(sheet, spot, marker, 4.0, colour);
        }
    }
    let head = match along {
        Along::Steps => "τ = 2",
        Along::Depth => "σ\u{302} = 20 max σₜ",
        Along::Origin => "τ = 2, 40 collisions",
    };
    panel.frame(sheet, head);
}

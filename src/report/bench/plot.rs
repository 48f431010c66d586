//! `CASE.svg` and `CASE.png`: the measured error against time and against lookups.
//!
//! Points are measured, with bars from the minimum to the maximum of the rounds; lines are √(V/n), with slope −1/2. The
//! thin, pale line of the same colour is that of the plain loop.

use plotters::style::{Color, RGBAColor};

use crate::bench::record::{Bench, BenchCase, BenchRow, CurvePoint, Times};
use crate::record::Digits;
use crate::report::lists::joined;
use crate::report::plots::figure::{Figure, Foot, LEFT, subject};
use crate::report::plots::legend::LegendEntry;
use crate::report::plots::series::{marks, numbered};
use crate::report::plots::style::Style;
use crate::report::plots::{self, Axis, Panel};
use crate::report::{Artifact, ReportError};
use drawing::Sheet;
use numeric::digits::count;

const WIDTH: f64 = 1200.0;
const TOP: f64 = 104.0;
const PANEL: [f64; 2] = [490.0, 400.0];
const PITCH: f64 = 600.0;

/// Dashes, width and colour of a line.
type LineStyle = (&'static [f64], f64, RGBAColor);

/// Line of the plot.
struct PlotSeries<'a> {
    row: &'a BenchRow,
    times: &'a Times,
    style: Style,
    label: String,
}

/// Returns the figure of a case in both formats.
pub(super) fn artifacts(bench: &Bench, case: &BenchCase) -> Result<Vec<Artifact>, ReportError> {
    plots::artifacts(&case.name, "", &figure(bench, case)?)
}

/// Returns the figure of a case.
pub(in crate::report) fn figure(bench: &Bench, case: &BenchCase) -> Result<Sheet, ReportError> {
    let shown = case.rows.iter().filter(|row| row.is_shown);
    let shown: Vec<_> =
        shown.filter_map(|row| row.times.as_ref().map(|times| (row, times))).collect();
    let labels = case.digits();
    let labels = numbered(shown.iter().map(|(row, _)| label(row, labels)).collect());
    let series: Vec<PlotSeries> = shown
        .into_iter()
        .zip(labels)
        .enumerate()
        .map(|(i, ((row, times), label))| PlotSeries { row, times, style: Style::of(i), label })
        .collect();
    let entries: Vec<LegendEntry> = series.iter().map(PlotSeries::entry).collect();
    let notes = notes(case);
    let foot = Foot { top: TOP + PANEL[1] + 84.0, entries: &entries, notes: &notes };
    let titles = [&*case.title, &subtitle(bench, case)];
    let mut figure = Figure::with_foot(&case.name, WIDTH, titles, &foot)?;
    let time = format!("{} time [s]", bench.conditions.clock.word());
    in_time(&mut figure.sheet, &series, &time);
    in_lookups(&mut figure.sheet, &series);
    Ok(figure.close(&foot))
}

fn subtitle(bench: &Bench, case: &BenchCase) -> String {
    let (rounds, threads) = (bench.rounds, bench.conditions.threads);
    let draws = format!("{rounds} rounds of {} draws", count(bench.draws));
    let (subject, threads) = (subject(&case.name, &case.medium), format!("threads: {threads}"));
    [subject, draws, threads, bench.conditions.level.clone()].join("  ·  ")
}

/// Returns the words for a row: its estimator, σ̂, control and channel, and what it needs.
fn label(row: &BenchRow, labels: Digits) -> String {
    let sampling = row.sampling().map(|sampling| format!("σ\u{302} = {}", labels.text(sampling)));
    let sampling = sampling.unwrap_or_else(|| row.id.sampling.kind.clone());
    let parts = [row.id.label(), sampling, row.id.control.clone(), row.channel.clone()];
    let marks = marks(&row.needs, row.setup_lookups.map(|count| count..=count), false);
    format!("{}{marks}", joined(parts, ", "))
}

impl PlotSeries<'_> {
    fn entry(&self) -> LegendEntry {
        let Style { colour, dash, marker } = self.style;
        let line = self.points().any(|point| point.predicted.is_some());
        LegendEntry {
            label: self.label.clone(),
            line: line.then_some((dash, 2.0)),
            marker: Some(marker),
            colour,
        }
    }

    fn points(&self) -> impl Iterator<Item = &CurvePoint> {
        self.row.curve.iter()
    }

    /// Draws the points and the predicted line at their prices.
    fn draw(&self, sheet: &mut Sheet, panel: &Panel, price: impl Fn(&CurvePoint) -> f64) {
        let Style { colour, dash, marker } = self.style;
        self.line(sheet, panel, &price, (dash, 1.8, colour));
        for point in self.points() {
            let Some(spot) = panel.spot(price(point), point.relative) else { continue };
            let ends = [point.least, point.relative, point.most];
            panel.bar(sheet, spot[0], ends, (3.5, 1.2, colour.mix(0.6)));
            panel.point(sheet, spot, marker, 4.4, colour);
        }
    }

    /// Draws the predicted line at the prices of its points.
    fn line(
        &self,
        sheet: &mut Sheet,
        panel: &Panel,
        price: impl Fn(&CurvePoint) -> f64,
        look: LineStyle,
    ) {
        let line = self.points().filter_map(|point| Some((price(point), point.predicted?)));
        panel.line(sheet, line, look);
    }
}

/// Returns the panel at this place, its axes around everything shown. Of an error bar it shows at most two decades
/// below the error itself, for a mean may agree with the truth by coincidence.
fn panel(
    place: f64,
    title: &str,
    prices: impl Iterator<Item = f64>,
    series: &[PlotSeries],
) -> Panel {
    let points = || series.iter().flat_map(PlotSeries::points);
    let errors = points().flat_map(|p| [p.relative, p.most, p.least.max(p.relative * 1e-2)]);
    let errors = errors.chain(points().filter_map(|point| point.predicted));
    let positive = |x: &f64| *x > 0.0 && x.is_finite();
    let x = Axis::around(title, true, 0.04, prices.filter(positive));
    let y = Axis::around("|mean − T| / T", true, 0.04, errors.filter(positive));
    Panel::at([LEFT + place * PITCH, TOP], PANEL, x, y)
}

fn in_time(sheet: &mut Sheet, series: &[PlotSeries], title: &str) {
    let seconds = series.iter().flat_map(|one| {
        let of = |point: &CurvePoint| {
            [one.times.seconds(point.draws), one.times.plain_seconds(point.draws)]
        };
        one.points().flat_map(of)
    });
    let panel = panel(0.0, title, seconds, series);
    panel.grid(sheet);
    for one in series {
        let look: LineStyle = (&[], 1.1, one.style.colour.mix(0.5));
        one.line(sheet, &panel, |point| one.times.plain_seconds(point.draws), look);
    }
    for one in series {
        one.draw(sheet, &panel, |point| one.times.seconds(point.draws));
    }
    panel.frame(sheet, "(a) Error against time; thin lines: the plain loop");
}

fn in_lookups(sheet: &mut Sheet, series: &[PlotSeries]) {
    let lookups = series.iter().flat_map(PlotSeries::points).map(|point| point.lookups);
    let panel = panel(1.0, "lookups of σₜ", lookups, series);
    panel.grid(sheet);
    for one in series {
        one.draw(sheet, &panel, |point| point.lookups);
    }
    panel.frame(sheet, "(b) Error against lookups");
}

/// Returns the meaning of the marks, and the facts that the plot cannot show, in words.
fn notes(case: &BenchCase) -> Vec<String> {
    let mut notes = vec![
        "Points: root mean square over the rounds. Bars: minimum and maximum, with an arrow where it is farther down. \
         Lines: √(V/n), of slope −1/2; V is the variance in theory, or else that of the draws."
            .to_owned(),
    ];
    let left_out = case.rows.iter().any(|row| !row.curve.is_empty() && !row.is_shown);
    if left_out {
        notes.push(
            "Shown are the point of a sweep with the largest figure of merit, and the last distance of a curve."
                .to_owned(),
        );
    }
    let lacking = case.rows.iter().filter(|row| !row.is_refused && !row.reason.is_empty());
    notes.extend(lacking.map(|row| format!("{}: {}", row.id.label(), row.reason)));
    notes.dedup();
    notes
}

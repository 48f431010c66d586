//! Panel of variance, cost or efficiency along a sweep: theory as lines, measurements as points with error bars. Stars
//! are the best constant σ̂ of each series: filled where the figure of merit is largest, hollow where it reaches 90 %
//! of its limit.

use crate::record::{Best, Compared, CurvePoint, Row};
use crate::report::lists::joined;
use crate::report::plots::Panel;
use crate::report::plots::legend::{self, MarkerKey};
use crate::report::plots::overlap::{self, Class, PlotLine, classes, side_by_side, smallest_step};
use crate::report::plots::series::Series;
use crate::report::plots::style::{DARK, Marker, PAPER};
use crate::report::run::fields;
use crate::report::run::sweep_plot::names::{self, Course};
use drawing::Sheet;
use drawing::font::Typeface;
use numeric::digits::short;
use plotters::style::Color;

/// Width of the place of an estimator outside of the sweep, at the right edge.
pub const PLACE: f64 = 13.0;
/// Distance from the middle of a marker within which it hides everything.
const HIDDEN: f64 = 3.5;
/// Distance of points below which they hide each other.
const APART: f64 = 8.0;

/// Quantity of a panel, of rows and of curves.
#[derive(Clone, Copy)]
pub struct PanelQuantity {
    /// Heading; its second character is the letter of the panel.
    pub head: &'static str,
    /// Title of the axis.
    pub title: &'static str,
    /// Values of a row.
    pub values: fn(&Row) -> Compared,
    /// Value on the predicted line.
    pub theory: fn(&CurvePoint) -> f64,
}

/// Measured point: its series, its place, and the ends of its error bar about it.
struct MeasuredPoint {
    series: usize,
    spot: [f64; 2],
    bar: Option<[f64; 3]>,
    tip: String,
}

/// Panel with its drawing.
pub struct Graph {
    /// The panel.
    pub panel: Panel,
    head: &'static str,
    lines: Vec<PlotLine>,
    classes: Vec<Class>,
    points: Vec<MeasuredPoint>,
    /// True if points were moved aside.
    is_moved: bool,
}

impl Graph {
    /// Lays out a quantity of the series in a panel.
    pub fn new(panel: Panel, quantity: PanelQuantity, series: &[Series]) -> Self {
        let lines: Vec<PlotLine> = series.iter().map(|one| line(one, &quantity, &panel)).collect();
        let mut points = points(&panel, &quantity, series);
        let spots: Vec<[f64; 2]> = points.iter().map(|point| point.spot).collect();
        let swept = points.iter().filter(|point| !series[point.series].is_fixed());
        let gap = smallest_step(swept.map(|point| point.spot[0])).min(100.0);
        let shifts = side_by_side(&spots, APART, 0.4 * gap);
        let is_moved = shifts.iter().any(|&shift| shift != 0.0);
        points.iter_mut().zip(shifts).for_each(|(point, shift)| point.spot[0] += shift);
        let dashes: Vec<&[f64]> = series.iter().map(|one| one.style.dash).collect();
        let classes = classes(&lines, &dashes);
        Self { panel, head: quantity.head, lines, classes, points, is_moved }
    }

    /// Draws the panel.
    pub fn draw(&self, sheet: &mut Sheet, series: &[Series]) {
        let panel = &self.panel;
        panel.grid(sheet);
        for class in &self.classes {
            for &member in &class.members {
                let style = series[member].style;
                let dash = class.dash(member, style.dash);
                match &self.lines[member] {
                    PlotLine::Points(points) => {
                        panel.line(sheet, points.iter().copied(), (&dash, 2.0, style.colour));
                    }
                    PlotLine::Level(y) => {
                        let across = [panel.x.low, panel.x.high].map(|x| (x, *y));
                        panel.line(sheet, across, (&dash, 1.6, style.colour));
                    }
                    PlotLine::None => {}
                }
            }
        }
        for MeasuredPoint { series: of, spot, bar, tip } in &self.points {
            sheet.tip(*spot, tip.clone());
            let style = series[*of].style;
            // A bar within its marker cannot be seen.
            let is_seen = |bar: &&[f64; 3]| {
                panel.cuts(**bar)
                    || bar
                        .iter()
                        .filter_map(|&y| panel.down(y))
                        .any(|y| (y - spot[1]).abs() > HIDDEN)
            };
            if let Some(bar) = bar.as_ref().filter(is_seen) {
                panel.bar(sheet, spot[0], *bar, (4.5, 1.4, style.colour));
            }
            panel.point(sheet, *spot, style.marker, 4.6, style.colour);
        }
        panel.frame(sheet, self.head);
    }

    /// Writes the names of curves that are apart beside them.
    pub fn write_names(&self, face: &Typeface, sheet: &mut Sheet, series: &[Series]) {
        let courses = series.iter().enumerate().map(|(index, one)| {
            let of_line: Vec<(f64, f64)> = match &self.lines[index] {
                PlotLine::Points(points) => points.clone(),
                PlotLine::Level(y) => [self.panel.x.low, self.panel.x.high].map(|x| (x, *y)).into(),
                PlotLine::None => Vec::new(),
            };
            let of_line = of_line.iter().filter_map(|&(x, y)| self.panel.spot(x, y));
            let own = self.points.iter().filter(|point| point.series == index);
            let mut spots: Vec<_> = of_line.chain(own.map(|point| point.spot)).collect();
            spots.retain(|&spot| self.panel.holds(spot));
            spots.sort_by(|a, b| a[0].total_cmp(&b[0]));
            Course { name: one.label.clone(), colour: one.style.colour, spots }
        });
        let Panel { left, top, right, bottom, .. } = self.panel;
        let courses: Vec<Course> = courses.collect();
        names::draw(face, sheet, [left, top, right, bottom], &courses);
    }

    fn letter(&self) -> char {
        self.head.chars().nth(1).unwrap_or_default()
    }
}

/// Returns notes on equal lines, moved points and cut error bars.
pub fn notes(graphs: &[Graph], series: &[Series]) -> Vec<String> {
    let names: Vec<&str> = series.iter().map(|one| &*one.label).collect();
    let classes: Vec<(char, Vec<Class>)> =
        graphs.iter().map(|graph| (graph.letter(), graph.classes.clone())).collect();
    let mut notes = overlap::notes(&classes, &names);
    let letters = |test: &dyn Fn(&Graph) -> bool| -> String {
        let letters = graphs.iter().filter(|graph| test(graph)).map(Graph::letter);
        joined(letters.map(String::from), ", ")
    };
    let moved = letters(&|graph| graph.is_moved);
    if !moved.is_empty() {
        notes.push(format!("({moved}): points that would hide each other stand side by side"));
    }
    let cut = letters(&|graph| {
        graph.points.iter().filter_map(|point| point.bar).any(|bar| graph.panel.cuts(bar))
    });
    if !cut.is_empty() {
        notes.push(format!(
            "({cut}): an arrow on an error bar: it goes on beyond the panel, or down to 0, which a logarithmic axis \
             cannot show"
        ));
    }
    notes
}

/// Returns the predicted line within the panel: along the sweep, or a constant for an estimator that is not swept.
fn line(one: &Series, quantity: &PanelQuantity, panel: &Panel) -> PlotLine {
    let points = one.theory(quantity.theory, quantity.values);
    if !points.is_empty() {
        let has_place = points.iter().any(|&(x, y)| panel.spot(x, y).is_some());
        return if has_place { PlotLine::Points(points) } else { PlotLine::None };
    }
    let mut fixed = one.rows.iter().filter(|row| row.experiment.swept().is_none());
    let level = fixed.find_map(|row| {
        let Compared { measured, theory, .. } = (quantity.values)(row);
        theory.or(measured)
    });
    level.filter(|&y| panel.down(y).is_some()).map_or(PlotLine::None, PlotLine::Level)
}

/// Returns the measured points; estimators that are not swept have places at the right edge.
fn points(panel: &Panel, quantity: &PanelQuantity, series: &[Series]) -> Vec<MeasuredPoint> {
    let mut edge = panel.right - 9.0;
    let mut points = Vec::new();
    for (index, one) in series.iter().enumerate() {
        for row in &one.rows {
            let x = row.experiment.swept().map_or(Some(edge), |swept| panel.across(swept));
            let values = (quantity.values)(row);
            let place = values.measured.and_then(|value| Some((value, [x?, panel.down(value)?])));
            let Some((value, spot)) = place.filter(|(_, spot)| panel.holds(*spot)) else {
                continue;
            };
            if row.experiment.swept().is_none() {
                edge -= PLACE;
            }
            let tip = tip(row, quantity, values);
            let bar =
                values.deviation.map(|deviation| [value - deviation, value, value + deviation]);
            points.push(MeasuredPoint { series: index, spot, bar, tip });
        }
    }
    points
}

/// Returns the name and the value of a point, with its standard error and its value in theory.
fn tip(row: &Row, quantity: &PanelQuantity, values: Compared) -> String {
    let Compared { measured, deviation, theory, .. } = values;
    let [value, deviation, theory] =
        [measured, deviation, theory].map(|value| value.map(|value| short(value, 4)));
    let deviation = deviation.map_or(String::new(), |deviation| format!(" ± {deviation}"));
    let theory = theory.map_or(String::new(), |theory| format!(", theory {theory}"));
    format!("{}: {} {}{deviation}{theory}", row.name(), quantity.title, value.unwrap_or_default())
}

/// Returns whether the star of a best σ̂ is hollow, for the figure of merit has no maximum there; `None` for no star.
fn is_hollow(best: Option<&Best>) -> Option<bool> {
    let is_drawn = |best: &Best| best.limit.is_some() || best.is_optimum();
    best.map_or(Some(false), |best| is_drawn(best).then_some(best.limit.is_some()))
}

/// Marks the best σ̂ inside the sweep with a star and a thin line down to the axis, and adds the meaning of the stars.
pub fn draw_optima(face: &Typeface, sheet: &mut Sheet, panel: &Panel, series: &[Series]) {
    let (mut filled, mut hollow) = (false, false);
    for one in series {
        let Some(curve) = one.curve else { continue };
        let Some(best) = curve.optimum else { continue };
        let Some(is_hollow) = is_hollow(curve.best.as_ref()) else { continue };
        let Some(spot) = panel.spot(best.x, best.fom).filter(|&spot| panel.holds(spot)) else {
            continue;
        };
        let drop = vec![spot, [spot[0], panel.bottom]];
        sheet.dashed(drop, &[1.5, 3.0], 1.2, one.style.colour.mix(0.8));
        Marker::Star.draw(sheet, spot, 9.0, DARK);
        if is_hollow {
            Marker::Star.fill(sheet, spot, 7.5, one.style.colour);
            Marker::Star.fill(sheet, spot, 4.6, PAPER);
            hollow = true;
        } else {
            Marker::Star.fill(sheet, spot, 6.5, one.style.colour);
            filled = true;
        }
    }
    let key = |is_hollow, words| MarkerKey { marker: Marker::Star, is_hollow, words };
    let keys = [(filled, false, "predicted optimum"), (hollow, true, "90 % of the limit")];
    let keys =
        keys.into_iter().filter(|known| known.0).map(|(_, hollow, words)| key(hollow, words));
    let keys: Vec<MarkerKey> = keys.collect();
    legend::keys(face, sheet, [panel.right, panel.top - 15.0], &keys);
}

/// Returns a note on best σ̂ that are shares of limits, or have no star.
pub fn note_on_optima(series: &[Series]) -> Option<String> {
    let said = series.iter().filter_map(|one| {
        let curve = one.curve?;
        let best = curve.best.as_ref()?;
        let outside = if curve.optimum.is_none() { ", outside of the panel" } else { "" };
        let (label, at) = (&one.label, short(best.sampling, 4));
        match best.limit {
            Some(limit) => {
                let limit = short(limit, 4);
                let kind = fields::kind(best);
                Some(format!("{label} rises to {limit}, {kind} at σ\u{302} = {at}{outside}"))
            }
            None if outside.is_empty() && best.is_optimum() => None,
            None => Some(format!("{label}: {} at σ\u{302} = {at}{outside}", fields::kind(best))),
        }
    });
    let said = joined(said, "; ");
    (!said.is_empty()).then(|| format!("(c), best σ\u{302}: {said}"))
}

//! Plots of a page, each defined once and shown wherever it is needed. A sheet becomes the shapes of an SVG in few
//! bytes: consecutive shapes of one style are one path, from point to point by whole tenths of a pixel.

use std::fmt::Write;

use maud::{Markup, html};
use plotters::style::RGBAColor;

use crate::report::plots::sheet::{Align, Image, Label, Shape, Sheet, Spot};

/// Number of units of a pixel.
const UNITS: f64 = 10.0;
/// Largest distance of a coordinate from the sheet's corner, in units.
const FARTHEST: f64 = 1e6;
/// Shift that centres small letters on a line, in sizes of the em.
const HALF_A_LETTER: f64 = 0.27;

/// Plot that the page defines.
pub struct Plot {
    /// Anchor in the page.
    id: String,
    /// Description for readers of the page that cannot show it.
    label: String,
    view: String,
    shapes: Markup,
}

/// Style of a path.
#[derive(Clone, PartialEq)]
enum Look {
    /// Line of this width, in dashes of these lengths.
    Line(i64, RGBAColor, Vec<i64>),
    /// Filled.
    Fill(RGBAColor),
    /// Dots of this width.
    Dots(i64, RGBAColor),
}

/// Returns the view of a sheet, for the element around its shapes.
pub fn view(sheet: &Sheet) -> String {
    format!("0 0 {} {}", unit(sheet.width), unit(sheet.height))
}

/// Returns the shapes, for an element with `fill="none"`: text above everything else.
pub fn shapes(sheet: &Sheet) -> Markup {
    let mut open: Option<(Look, String)> = None;
    let mut all = Vec::new();
    let mut add = |look: Look, points: &[Spot]| {
        let is_same = open.as_ref().is_some_and(|(other, _)| *other == look);
        if !is_same {
            all.extend(open.take().map(|(look, way)| path(&look, &way)));
        }
        let (look, all) = open.get_or_insert_with(|| (look, String::new()));
        *all += &way(points.iter().map(|point| point.map(unit)));
        if matches!(look, Look::Fill(_)) {
            all.push('z');
        }
    };
    let mut texts = Vec::new();
    for shape in &sheet.shapes {
        match shape {
            Shape::Path { points, width, colour, dash } => {
                let dash = dash.iter().map(|&length| unit(length)).collect();
                add(Look::Line(unit(*width).max(1), *colour, dash), points);
            }
            Shape::Area { points, colour } => add(Look::Fill(*colour), points),
            Shape::Disc { at, radius, colour } => {
                add(Look::Dots(unit(2.0 * radius), *colour), &[*at]);
            }
            Shape::Image(image) => pixels(image, |corners, colour| {
                add(Look::Fill(colour), &corners);
            }),
            Shape::Text(label) => texts.push(text(label)),
        }
    }
    all.extend(open.map(|(look, way)| path(&look, &way)));
    html! { @for path in all { (path) } @for text in texts { (text) } }
}

/// Returns the path through points as text of an SVG; a single point has a segment of length 0.
pub fn way(points: impl IntoIterator<Item = [i64; 2]>) -> String {
    let mut way = String::new();
    let mut last: Option<[i64; 2]> = None;
    for [x, y] in points {
        // Writing to a string cannot fail.
        let _ = match last {
            None => write!(way, "M{x} {y}l"),
            Some(last) if last == [x, y] => continue,
            Some([x0, y0]) => {
                let parted = if way.ends_with('l') || x < x0 { "" } else { " " };
                let between = if y < y0 { "" } else { " " };
                write!(way, "{parted}{}{between}{}", x - x0, y - y0)
            }
        };
        last = Some([x, y]);
    }
    if way.ends_with('l') {
        way.push_str("0 0");
    }
    way
}

fn path(look: &Look, way: &str) -> Markup {
    match *look {
        Look::Fill(colour) => {
            html! { path fill=(hue(colour)) fill-opacity=[part(colour)] d=(way) {} }
        }
        Look::Line(width, colour, ref dash) => {
            let lengths: Vec<String> = dash.iter().map(i64::to_string).collect();
            let dash = (!dash.is_empty()).then(|| lengths.join(" "));
            html! {
                path stroke=(hue(colour)) stroke-opacity=[part(colour)] stroke-width=(width)
                    stroke-dasharray=[dash] d=(way) {}
            }
        }
        Look::Dots(width, colour) => html! {
            path stroke=(hue(colour)) stroke-opacity=[part(colour)] stroke-width=(width)
                stroke-linecap="round" d=(way) {}
        },
    }
}

fn text(label: &Label) -> Markup {
    let anchor = match label.align {
        Align::Start => None,
        Align::Middle => Some("middle"),
        Align::End => Some("end"),
    };
    let lower = HALF_A_LETTER * label.size;
    let [x, y] = label.at;
    let [x, y] = if label.upward { [x + lower, y] } else { [x, y + lower] }.map(unit);
    let turn = label.upward.then(|| format!("rotate(270 {x} {y})"));
    html! {
        text x=(x) y=(y) text-anchor=[anchor] font-size=(unit(label.size)) fill=(hue(label.colour)) transform=[turn] {
            (label.text)
        }
    }
}

/// Shows every pixel as a rectangle.
fn pixels(image: &Image, mut show: impl FnMut([Spot; 4], RGBAColor)) {
    let rows = image.pixels.len() / image.columns.max(1);
    let corner = |column: usize, row: usize| {
        let share = [column as f64 / image.columns as f64, row as f64 / rows as f64];
        [0, 1].map(|i| image.at[i] + image.size[i] * share[i])
    };
    for (i, &[red, green, blue]) in image.pixels.iter().enumerate() {
        let (column, row) = (i % image.columns, i / image.columns);
        let places = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let corners = places.map(|(right, down)| corner(column + right, row + down));
        show(corners, RGBAColor(red, green, blue, 1.0));
    }
}

/// Returns a colour, in three digits if these suffice.
fn hue(RGBAColor(red, green, blue, _): RGBAColor) -> String {
    let digits = [red, green, blue];
    if digits.iter().all(|digit| digit % 17 == 0) {
        let [red, green, blue] = digits.map(|digit| digit / 17);
        format!("#{red:x}{green:x}{blue:x}")
    } else {
        format!("#{red:02x}{green:02x}{blue:02x}")
    }
}

/// Returns the opacity; `None` for full opacity.
fn part(RGBAColor(.., alpha): RGBAColor) -> Option<String> {
    (alpha < 1.0).then(|| format!("{alpha:.2}"))
}

fn unit(length: f64) -> i64 {
    // NaN becomes the corner; figures clip to their panels long before.
    #[expect(clippy::cast_possible_truncation)]
    let whole = (length * UNITS).round().clamp(-FARTHEST, FARTHEST) as i64;
    whole
}

/// Returns the plot of a sheet.
pub fn plot(id: String, label: String, sheet: &Sheet) -> Plot {
    Plot { id, label, view: view(sheet), shapes: shapes(sheet) }
}

impl Plot {
    /// Shows the plot, as large as its place allows.
    pub fn show(&self) -> Markup {
        html! {
            div.wide tabindex="0" role="group" aria-label="plot" {
                svg.plot viewBox=(self.view) role="img" aria-label=(self.label) {
                    use href={ "#" (self.id) } {}
                }
            }
        }
    }
}

/// Returns the shapes of all plots, hidden.
pub fn definitions(plots: &[Vec<Plot>]) -> Markup {
    html! {
        svg.hidden aria-hidden="true" focusable="false" {
            @for plot in plots.iter().flatten() {
                symbol id=(plot.id) viewBox=(plot.view) fill="none" { (plot.shapes) }
            }
        }
    }
}

//! Writes a sheet as an SVG in few bytes: consecutive shapes of one style are one path, from point to point by whole
//! tenths of a pixel.

use std::fmt::Write;

use crate::report::html::template::{Markup, html};
use plotters::style::RGBAColor;

use drawing::font::{BASELINE, FAMILY};
use drawing::sheet::{Align, Label, Shape, Sheet, Spot};

/// Number of units of a pixel.
const UNITS: f64 = 10.0;
/// Largest distance of a coordinate from the sheet's corner, in units.
const MAX_COORDINATE: f64 = 1e6;

/// Style of a path.
#[derive(Clone, PartialEq)]
enum PathStyle {
    /// Line of this width, in dashes of these lengths.
    Line(i64, RGBAColor, Vec<i64>),
    /// Filled.
    Fill(RGBAColor),
    /// Dots of this width.
    Dots(i64, RGBAColor),
}

/// Returns the sheet as a file.
pub fn document(sheet: &Sheet) -> String {
    let [width, height] = [sheet.width, sheet.height].map(f64::ceil);
    let svg = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox=(view(sheet)) fill="none"
            font-family=(FAMILY) {
            rect width="100%" height="100%" fill="#fff" {}
            (shapes(sheet))
        }
    };
    svg.into_string()
}

/// Returns the view of a sheet, for the element around its shapes.
pub fn view(sheet: &Sheet) -> String {
    format!("0 0 {} {}", unit(sheet.width), unit(sheet.height))
}

/// Returns the shapes, for an element with `fill="none"`: text above everything else.
pub fn shapes(sheet: &Sheet) -> Markup {
    let mut open: Option<(PathStyle, String)> = None;
    let mut all = Vec::new();
    let mut add = |look: PathStyle, points: &[Spot]| {
        let is_same = open.as_ref().is_some_and(|(other, _)| *other == look);
        if !is_same {
            all.extend(open.take().map(|(look, way)| path(&look, &way)));
        }
        let (look, all) = open.get_or_insert_with(|| (look, String::new()));
        *all += &way(points.iter().map(|point| point.map(unit)));
        if matches!(look, PathStyle::Fill(_)) {
            all.push('z');
        }
    };
    let mut texts = Vec::new();
    for shape in &sheet.shapes {
        match shape {
            Shape::Path { points, width, colour, dash } => {
                let dash = dash.iter().map(|&length| unit(length)).collect();
                add(PathStyle::Line(unit(*width).max(1), *colour, dash), points);
            }
            Shape::Area { points, colour } => add(PathStyle::Fill(*colour), points),
            Shape::Disc { at, radius, colour } => {
                add(PathStyle::Dots(unit(2.0 * radius), *colour), &[*at]);
            }
            Shape::Image(image) => {
                image.cells().for_each(|(corners, colour)| add(PathStyle::Fill(colour), &corners));
            }
            Shape::Text(label) if label.text.is_empty() => {}
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

fn path(look: &PathStyle, way: &str) -> Markup {
    match *look {
        PathStyle::Fill(colour) => {
            html! { path fill=(hue(colour)) fill-opacity=[part(colour)] d=(way) {} }
        }
        PathStyle::Line(width, colour, ref dash) => {
            let lengths: Vec<String> = dash.iter().map(i64::to_string).collect();
            let dash = (!dash.is_empty()).then(|| lengths.join(" "));
            html! {
                path stroke=(hue(colour)) stroke-opacity=[part(colour)] stroke-width=(width)
                    stroke-dasharray=[dash] d=(way) {}
            }
        }
        PathStyle::Dots(width, colour) => html! {
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
    let lower = BASELINE * label.size;
    let [x, y] = label.at;
    let [x, y] = if label.upward { [x + lower, y] } else { [x, y + lower] }.map(unit);
    let turn = label.upward.then(|| format!("rotate(270 {x} {y})"));
    html! {
        text x=(x) y=(y) text-anchor=[anchor] font-size=(unit(label.size)) fill=(hue(label.colour)) transform=[turn] {
            (label.text)
        }
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

/// Returns a length in whole units.
pub fn unit(length: f64) -> i64 {
    // NaN becomes the corner; figures clip to their panels long before.
    #[expect(clippy::cast_possible_truncation)]
    let whole = (length * UNITS).round().clamp(-MAX_COORDINATE, MAX_COORDINATE) as i64;
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plots::style::DARK;

    #[test]
    fn each_dashed_line_is_one_path() {
        let mut sheet = Sheet::new(40.0, 30.0);
        let line = |y: f64| vec![[0.0, y], [20.0, y], [40.0, y]];
        sheet.path(line(5.0), 2.0, DARK);
        sheet.dashed(line(10.0), &[9.0, 4.5], 2.0, DARK);
        sheet.area(line(20.0), DARK);
        sheet.dashed(line(25.0), &[0.0, 9.0, 9.0, 0.0], 2.0, DARK);
        let svg = document(&sheet);
        let paths: Vec<&str> = svg.split("<path ").skip(1).collect();
        assert_eq!(paths.len(), 4);
        assert!(
            paths[0].contains("d=\"M0 50l200 0 200 0\"") && !paths[0].contains("dash"),
            "{svg}"
        );
        assert!(
            paths[1].contains("stroke-dasharray=\"90 45\"") && paths[1].contains("M0 100l"),
            "{svg}"
        );
        assert!(paths[2].contains("fill=") && paths[2].contains("z\""), "{svg}");
        assert!(paths[3].contains("stroke-dasharray=\"0 90 90 0\""), "{svg}");
    }

    #[test]
    fn points_beyond_all_integers_are_written() {
        let mut sheet = Sheet::new(40.0, 30.0);
        let far = [f64::MAX, f64::MIN, f64::INFINITY, f64::NAN, 1e300, -1e300];
        sheet.path(far.iter().zip(far.iter().rev()).map(|(&x, &y)| [x, y]).collect(), 2.0, DARK);
        sheet.text([1e300, -1e300], "<far & away>", 12.0, DARK, Align::Start);
        let svg = document(&sheet);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        assert!(svg.contains("&lt;far &amp; away&gt;"), "{svg}");
    }
}

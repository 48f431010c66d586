//! Names of curves beside them, where they are apart: a reader need not look them up in the legend.

use crate::report::plots::style::DARK;
use drawing::font::Typeface;
use drawing::sheet::{Align, Sheet, Spot};
use plotters::style::RGBAColor;

/// Size of a name.
const SIZE: f64 = 12.5;
/// Height of a line of text.
const HEIGHT: f64 = 15.0;
/// Distances of the middle of a name from its own curve that are tried: a steep curve needs more.
const AWAY: [f64; 3] = [15.0, 20.0, 26.0];
/// Distance that a name keeps from other curves and markers.
const CLEAR: f64 = 9.0;
/// Distance of places that are tried, and of points of a curve that a name keeps clear of.
const STEP: f64 = 4.0;
/// Largest part of the width of a panel that a name may take.
const MAX_SHARE: f64 = 0.45;

/// Curve on the sheet.
pub struct Course {
    /// Name.
    pub name: String,
    /// Colour.
    pub colour: RGBAColor,
    /// Points of the line and of its markers, ascending in x.
    pub spots: Vec<Spot>,
}

/// Rectangle: left, top, right, bottom.
type Frame = [f64; 4];

/// Writes the name of each curve above or below it, from the right end on, where no curve, marker or name is near.
pub fn draw(face: &Typeface, sheet: &mut Sheet, panel: Frame, courses: &[Course]) {
    let dense: Vec<Vec<Spot>> = courses.iter().map(|course| dense(&course.spots)).collect();
    let mut taken: Vec<Frame> = Vec::new();
    for (own, course) in courses.iter().enumerate() {
        let width = face.width(&course.name, SIZE);
        if width > MAX_SHARE * (panel[2] - panel[0]) {
            continue;
        }
        let free = |frame: &Frame| {
            let is_near = |spot: &Spot, by: f64| holds(widened(*frame, by), *spot);
            let of_others = dense.iter().enumerate().filter(|(other, _)| *other != own);
            frame[0] > panel[0] + CLEAR
                && frame[1] > panel[1] + CLEAR
                && frame[2] < panel[2] - CLEAR
                && frame[3] < panel[3] - CLEAR
                && !dense[own].iter().any(|spot| is_near(spot, 1.0))
                && !course.spots.iter().any(|spot| is_near(spot, 4.0))
                && !of_others.flat_map(|(_, spots)| spots).any(|spot| is_near(spot, CLEAR))
                && !taken.iter().any(|other| overlap(widened(*frame, CLEAR), *other))
        };
        let places = AWAY.into_iter().flat_map(|away| {
            let spots = dense[own].iter().rev();
            spots.flat_map(move |&[x, y]| [y - away, y + away].map(|y| frame([x, y], width)))
        });
        if let Some(frame) = places.into_iter().find(free) {
            let at = [frame[0], frame[1].midpoint(frame[3])];
            sheet.text(at, &course.name, SIZE, darker(course.colour), Align::Start);
            taken.push(frame);
        }
    }
}

/// Returns points of a curve at most a step apart.
fn dense(spots: &[Spot]) -> Vec<Spot> {
    let mut dense = Vec::new();
    for pair in spots.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let steps = ((to[0] - from[0]).hypot(to[1] - from[1]) / STEP).ceil().clamp(1.0, 1e4);
        let mut step = 0.0;
        while step < steps {
            dense.push([0, 1].map(|i| from[i] + (to[i] - from[i]) * step / steps));
            step += 1.0;
        }
    }
    dense.extend(spots.last());
    dense
}

/// Returns the frame of a name with its middle at a place.
fn frame([x, y]: Spot, width: f64) -> Frame {
    [x - width / 2.0, y - HEIGHT / 2.0, x + width / 2.0, y + HEIGHT / 2.0]
}

fn widened([left, top, right, bottom]: Frame, by: f64) -> Frame {
    [left - by, top - by, right + by, bottom + by]
}

fn holds([left, top, right, bottom]: Frame, [x, y]: Spot) -> bool {
    (left..=right).contains(&x) && (top..=bottom).contains(&y)
}

fn overlap(a: Frame, b: Frame) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Returns a colour that is dark enough for small letters.
fn darker(RGBAColor(red, green, blue, _): RGBAColor) -> RGBAColor {
    let [red, green, blue] = [(red, DARK.0), (green, DARK.1), (blue, DARK.2)].map(|(own, dark)| {
        let mixed = (3 * u16::from(own) + 2 * u16::from(dark)) / 5;
        u8::try_from(mixed).unwrap_or(u8::MAX)
    });
    RGBAColor(red, green, blue, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::plots::style::COLOURS;
    use drawing::sheet::Shape;

    fn course(name: &str, ends: [f64; 2]) -> Course {
        let spots = vec![[0.0, ends[0]], [400.0, ends[1]]];
        Course { name: name.to_owned(), colour: COLOURS[0], spots }
    }

    fn named(courses: &[Course]) -> Vec<(String, Spot)> {
        let face = Typeface::load().expect("a typeface");
        let mut sheet = Sheet::new(400.0, 300.0);
        draw(&face, &mut sheet, [0.0, 0.0, 400.0, 300.0], courses);
        let texts = sheet.shapes.into_iter().filter_map(|shape| match shape {
            Shape::Text(label) => Some((label.text, label.at)),
            _ => None,
        });
        texts.collect()
    }

    #[test]
    fn curves_that_are_apart_are_named() {
        let finding = named(&[course("upper", [60.0, 60.0]), course("lower", [240.0, 200.0])]);
        assert_eq!(finding.len(), 2);
        assert!(
            finding[0].0 == "upper" && (finding[0].1[1] - 60.0).abs() <= AWAY[0],
            "{finding:?}"
        );
        assert!(finding[1].1[0] > 250.0, "{finding:?}");
    }

    #[test]
    fn a_crowd_of_curves_is_left_to_the_legend() {
        let crowd: Vec<Course> =
            (0..20).map(|i| course("a name", [f64::from(i) * 15.0, f64::from(i) * 15.0])).collect();
        assert!(named(&crowd).is_empty());
    }
}

//! Coordinate system of a figure: frame, grid, titles, and the drawing inside.

use plotters::style::RGBAColor;

use crate::report::plots::Axis;
use crate::report::plots::style::{DARK, FAINT, Marker};
use drawing::sheet::{Align, Sheet, Spot};

/// Size of labels on ticks.
const TICK: f64 = 13.0;
/// Size of titles of axes and panels.
const TITLE: f64 = 14.5;

/// Length of the end of an error bar that leaves the panel, in pixels.
const STUB: f64 = 20.0;

/// Rectangle of the sheet with two axes.
#[derive(Debug, Clone)]
pub struct Panel {
    /// `x` of the sheet at the left edge.
    pub left: f64,
    /// `y` of the sheet at the upper edge.
    pub top: f64,
    /// `x` of the sheet at the right edge.
    pub right: f64,
    /// `y` of the sheet at the lower edge.
    pub bottom: f64,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
}

impl Panel {
    /// Returns a panel by its upper left corner and its size.
    pub fn at([left, top]: Spot, [width, height]: [f64; 2], x: Axis, y: Axis) -> Self {
        Self { left, top, right: left + width, bottom: top + height, x, y }
    }

    /// Returns the place of a point on the sheet, inside the panel or not.
    pub fn spot(&self, x: f64, y: f64) -> Option<Spot> {
        Some([self.across(x)?, self.down(y)?])
    }

    /// Returns the `x` on the sheet of a value of the horizontal axis.
    pub fn across(&self, x: f64) -> Option<f64> {
        Some(self.left + (self.right - self.left) * self.x.place(x)?)
    }

    /// Returns the `y` on the sheet of a value of the vertical axis.
    pub fn down(&self, y: f64) -> Option<f64> {
        Some(self.bottom - (self.bottom - self.top) * self.y.place(y)?)
    }

    /// Returns whether a spot lies in the panel.
    pub fn holds(&self, [x, y]: Spot) -> bool {
        (self.left - 0.5..=self.right + 0.5).contains(&x)
            && (self.top - 0.5..=self.bottom + 0.5).contains(&y)
    }

    /// Draws the grid, which lies behind the data.
    pub fn grid(&self, sheet: &mut Sheet) {
        let [across, down] = self.ticks();
        for (x, _) in across.into_iter().filter(|(_, label)| !label.is_empty()) {
            sheet.path(vec![[x, self.top], [x, self.bottom]], 1.0, FAINT);
        }
        for (y, _) in down.into_iter().filter(|(_, label)| !label.is_empty()) {
            sheet.path(vec![[self.left, y], [self.right, y]], 1.0, FAINT);
        }
    }

    /// Returns the ticks of both axes, each with its place on the sheet and its label.
    fn ticks(&self) -> [Vec<(f64, String)>; 2] {
        let across = self.x.ticks(7).into_iter();
        let down = self.y.ticks(6).into_iter();
        [
            across.filter_map(|tick| Some((self.across(tick.at)?, tick.label))).collect(),
            down.filter_map(|tick| Some((self.down(tick.at)?, tick.label))).collect(),
        ]
    }

    /// Draws frame, ticks, labels and titles, which lie before the data.
    pub fn frame(&self, sheet: &mut Sheet, head: &str) {
        let [left, top, right, bottom] = [self.left, self.top, self.right, self.bottom];
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        for side in corners.windows(2) {
            sheet.path(side.to_vec(), 1.0, DARK);
        }
        let length = |label: &str| if label.is_empty() { 3.0 } else { 6.0 };
        let [across, down] = self.ticks();
        for (x, label) in across {
            sheet.path(vec![[x, bottom], [x, bottom - length(&label)]], 1.0, DARK);
            sheet.text([x, bottom + 15.0], label, TICK, DARK, Align::Middle);
        }
        for (y, label) in down {
            sheet.path(vec![[left, y], [left + length(&label), y]], 1.0, DARK);
            sheet.text([left - 8.0, y], label, TICK, DARK, Align::End);
        }
        let [middle, centre] = [left.midpoint(right), top.midpoint(bottom)];
        sheet.text([middle, bottom + 38.0], &self.x.title, TITLE, DARK, Align::Middle);
        sheet.upward([left - 66.0, centre], &self.y.title, TITLE, DARK);
        sheet.text([left, top - 15.0], head, TITLE, DARK, Align::Start);
    }

    /// Draws a line through points, cut off at the panel's edges and interrupted at points without a place.
    pub fn line(
        &self,
        sheet: &mut Sheet,
        points: impl IntoIterator<Item = (f64, f64)>,
        (dash, width, colour): (&[f64], f64, RGBAColor),
    ) {
        let mut run: Vec<Spot> = Vec::new();
        let mut last = None;
        for (x, y) in points {
            let next = self.spot(x, y);
            let inside = last.zip(next).and_then(|(from, to)| self.clipped(from, to));
            if let Some([from, to]) = inside {
                if run.last() != Some(&from) {
                    sheet.dashed(std::mem::take(&mut run), dash, width, colour);
                    run.push(from);
                }
                run.push(to);
            }
            last = next;
        }
        sheet.dashed(run, dash, width, colour);
    }

    /// Fills the area between two lines, cut off at the panel's upper and lower edges.
    pub fn band(
        &self,
        sheet: &mut Sheet,
        bounds: impl IntoIterator<Item = (f64, f64, f64)>,
        colour: RGBAColor,
    ) {
        let (mut upper, mut lower) = (Vec::new(), Vec::new());
        for (x, low, high) in bounds {
            if let (Some(x), Some(low), Some(high)) =
                (self.across(x), self.down(low), self.down(high))
            {
                let x = x.clamp(self.left, self.right);
                upper.push([x, high.clamp(self.top, self.bottom)]);
                lower.push([x, low.clamp(self.top, self.bottom)]);
            }
        }
        upper.extend(lower.into_iter().rev());
        sheet.area(upper, colour);
    }

    /// Draws a marker, if its place is in the panel.
    pub fn point(&self, sheet: &mut Sheet, at: Spot, marker: Marker, size: f64, colour: RGBAColor) {
        if self.holds(at) {
            marker.draw(sheet, at, size, colour);
        }
    }

    /// Draws a vertical error bar around a value at the sheet's `x`, with caps of this width if its ends lie in the
    /// panel. An end outside is an arrow: at the edge, or on a logarithmic axis close to the value, for a bar down to 0
    /// would cross all decades.
    pub fn bar(
        &self,
        sheet: &mut Sheet,
        x: f64,
        [low, value, high]: [f64; 3],
        (cap, width, colour): (f64, f64, RGBAColor),
    ) {
        let middle = self.down(value).filter(|&y| self.holds([x, y]));
        let Some(middle) = middle.filter(|_| !(low.is_nan() || high.is_nan())) else { return };
        let ends = [(high, -1.0), (low, 1.0)].map(|(end, sign)| {
            if let Some(y) = self.down(end).filter(|&y| self.holds([x, y])) {
                return (y, y);
            }
            let stub = if self.y.log { STUB } else { self.bottom - self.top };
            let tip = (middle + sign * stub).clamp(self.top, self.bottom);
            (tip, tip - sign * cap)
        });
        sheet.path(ends.map(|(tip, _)| [x, tip]).to_vec(), width, colour);
        for (tip, back) in ends {
            sheet.path(vec![[x - cap, back], [x, tip], [x + cap, back]], width, colour);
        }
    }

    /// Returns whether an end of an error bar becomes an arrow.
    pub fn cuts(&self, [low, value, high]: [f64; 3]) -> bool {
        let is_shown = |y: f64| self.down(y).is_some_and(|y| self.holds([self.left, y]));
        is_shown(value) && !(is_shown(low) && is_shown(high))
    }

    /// Returns the part of a stroke inside the panel (Y.-D. Liang and B. A. Barsky, "A New Concept and Method for Line
    /// Clipping", 1984).
    fn clipped(&self, from: Spot, to: Spot) -> Option<[Spot; 2]> {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for (speed, room) in [
            (-dx, from[0] - self.left),
            (dx, self.right - from[0]),
            (-dy, from[1] - self.top),
            (dy, self.bottom - from[1]),
        ] {
            if speed == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if speed < 0.0 {
                enter = enter.max(room / speed);
            } else {
                leave = leave.min(room / speed);
            }
        }
        let at = |s: f64| if s == 1.0 { to } else { [from[0] + s * dx, from[1] + s * dy] };
        (enter <= leave).then(|| [at(enter), at(leave)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use drawing::sheet::Shape;

    fn panel() -> Panel {
        let axis = |log| Axis { title: String::new(), log, low: 1.0, high: 10.0 };
        Panel { left: 0.0, top: 0.0, right: 90.0, bottom: 90.0, x: axis(false), y: axis(true) }
    }

    /// Returns the points of all shapes.
    fn paths(sheet: &Sheet) -> Vec<Vec<Spot>> {
        let points = |shape: &Shape| match shape {
            Shape::Path { points, .. } => points.clone(),
            other => panic!("not a path: {other:?}"),
        };
        sheet.shapes.iter().map(points).collect()
    }

    #[test]
    fn lines_end_at_the_edge_and_break_where_there_is_no_place() {
        let mut sheet = Sheet::new(90.0, 90.0);
        let points = [(1.0, 1.0), (5.5, 100.0), (6.0, 0.0), (7.0, 2.0), (8.0, 2.0)];
        panel().line(&mut sheet, points, (&[], 1.0, DARK));
        let paths = paths(&sheet);
        assert_eq!(paths.len(), 2);
        assert_eq!(paths[0], [[0.0, 90.0], [22.5, 0.0]]);
    }

    #[test]
    fn an_error_bar_down_to_zero_is_an_arrow_on_a_logarithmic_panel() {
        let mut sheet = Sheet::new(90.0, 90.0);
        let bar = [0.0, 10_f64.powf(0.5), 10.0];
        assert!(panel().cuts(bar) && !panel().cuts([2.0, 3.0, 4.0]));
        panel().bar(&mut sheet, 45.0, bar, (3.0, 1.0, DARK));
        let paths = paths(&sheet);
        // A cap at the upper end, a stub with an arrow at the lower one.
        assert_eq!(paths[0], [[45.0, 0.0], [45.0, 45.0 + STUB]]);
        assert_eq!(paths[1], [[42.0, 0.0], [45.0, 0.0], [48.0, 0.0]]);
        assert_eq!(paths[2], [[42.0, 42.0 + STUB], [45.0, 45.0 + STUB], [48.0, 42.0 + STUB]]);
        assert_eq!(paths.len(), 3);
    }

    #[test]
    fn no_error_bar_leaves_the_panel() {
        let odd = [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e-300, 2.0, 9.0, 1e300];
        let mut sheet = Sheet::new(90.0, 90.0);
        for low in odd {
            for value in odd {
                for high in odd {
                    panel().bar(&mut sheet, 45.0, [low, value, high], (3.0, 1.0, DARK));
                }
            }
        }
        assert!(!sheet.shapes.is_empty());
        for points in paths(&sheet) {
            assert!(points.iter().all(|&spot| panel().holds(spot)), "{points:?}");
        }
    }
}

//! Drawing as a list of shapes, in units of one pixel at normal size, `y` downwards.

use plotters::style::RGBAColor;

/// Point of the sheet.
pub type Spot = [f64; 2];

/// Shape.
#[derive(Debug, Clone)]
pub enum Shape {
    /// Line through points.
    Path {
        /// Points.
        points: Vec<Spot>,
        /// Width of the line.
        width: f64,
        /// Colour.
        colour: RGBAColor,
        /// Lengths of stroke and gap in turn; empty for a solid line.
        dash: Vec<f64>,
    },
    /// Filled polygon.
    Area {
        /// Corners.
        points: Vec<Spot>,
        /// Colour.
        colour: RGBAColor,
    },
    /// Filled circle.
    Disc {
        /// Centre.
        at: Spot,
        /// Radius.
        radius: f64,
        /// Colour.
        colour: RGBAColor,
    },
    /// Line of text.
    Text(Label),
    /// Image.
    Image(Image),
}

/// Rectangle of pixels.
#[derive(Debug, Clone)]
pub struct Image {
    /// Upper left corner.
    pub at: Spot,
    /// Width and height on the sheet.
    pub size: Spot,
    /// Number of pixels in a row.
    pub columns: usize,
    /// Red, green and blue of each, row after row from the top.
    pub pixels: Vec<[u8; 3]>,
}

impl Image {
    /// Returns the corners of every pixel, from the upper left one clockwise, and its colour.
    pub fn cells(&self) -> impl Iterator<Item = ([Spot; 4], RGBAColor)> {
        let rows = self.pixels.len() / self.columns.max(1);
        let corner = move |column: usize, row: usize| {
            let share = [column as f64 / self.columns as f64, row as f64 / rows as f64];
            [0, 1].map(|i| self.at[i] + self.size[i] * share[i])
        };
        self.pixels.iter().enumerate().map(move |(i, &[red, green, blue])| {
            let (column, row) = (i % self.columns, i / self.columns);
            let places = [(0, 0), (1, 0), (1, 1), (0, 1)];
            let corners = places.map(|(right, down)| corner(column + right, row + down));
            (corners, RGBAColor(red, green, blue, 1.0))
        })
    }
}

/// Line of text, centred in height on its place.
#[derive(Debug, Clone)]
pub struct Label {
    /// Place.
    pub at: Spot,
    /// Text.
    pub text: String,
    /// Size of the em.
    pub size: f64,
    /// Colour.
    pub colour: RGBAColor,
    /// Part of the text at its place.
    pub align: Align,
    /// True if it runs upwards.
    pub upward: bool,
}

/// Part of a text at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Beginning.
    Start,
    /// Middle.
    Middle,
    /// End.
    End,
}

/// Value that a page shows where the pointer or the keyboard is.
#[derive(Debug, Clone)]
pub struct Tip {
    /// Place.
    pub at: Spot,
    /// Value in words.
    pub text: String,
}

/// Drawing.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
    /// Shapes, from the back to the front.
    pub shapes: Vec<Shape>,
    /// Values of its points, for pages.
    pub tips: Vec<Tip>,
}

impl Sheet {
    /// Returns an empty sheet.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, shapes: Vec::new(), tips: Vec::new() }
    }

    /// Adds the value of a point.
    pub fn tip(&mut self, at: Spot, text: String) {
        self.tips.push(Tip { at, text });
    }

    /// Draws a line through points; fewer than two draw nothing.
    pub fn path(&mut self, points: Vec<Spot>, width: f64, colour: RGBAColor) {
        self.dashed(points, &[], width, colour);
    }

    /// Draws the outline of a rectangle.
    pub fn frame(&mut self, [left, top]: Spot, [width, height]: Spot, colour: RGBAColor) {
        let (right, low) = (left + width, top + height);
        let corners = vec![[left, top], [right, top], [right, low], [left, low], [left, top]];
        self.path(corners, 1.0, colour);
    }

    /// Fills a polygon.
    pub fn area(&mut self, points: Vec<Spot>, colour: RGBAColor) {
        if points.len() > 2 {
            self.shapes.push(Shape::Area { points, colour });
        }
    }

    /// Fills a circle.
    pub fn disc(&mut self, at: Spot, radius: f64, colour: RGBAColor) {
        self.shapes.push(Shape::Disc { at, radius, colour });
    }

    /// Adds an image.
    pub fn image(&mut self, image: Image) {
        self.shapes.push(Shape::Image(image));
    }

    /// Writes a horizontal line of text.
    pub fn text(
        &mut self,
        at: Spot,
        text: impl Into<String>,
        size: f64,
        colour: RGBAColor,
        align: Align,
    ) {
        let text = text.into();
        self.shapes.push(Shape::Text(Label { at, text, size, colour, align, upward: false }));
    }

    /// Writes a line of text that runs upwards, with its middle at the place.
    pub fn upward(&mut self, at: Spot, text: impl Into<String>, size: f64, colour: RGBAColor) {
        let (text, align) = (text.into(), Align::Middle);
        self.shapes.push(Shape::Text(Label { at, text, size, colour, align, upward: true }));
    }

    /// Draws a dashed line: lengths of stroke and gap in turn, one of them at least above 0. Without any it is solid.
    pub fn dashed(&mut self, points: Vec<Spot>, dash: &[f64], width: f64, colour: RGBAColor) {
        if points.len() > 1 {
            let dash = dash.to_vec();
            self.shapes.push(Shape::Path { points, width, colour, dash });
        }
    }
}

/// Returns the strokes of a dashed line, for backends without dashes.
pub fn strokes(points: &[Spot], dash: &[f64]) -> Vec<Vec<Spot>> {
    if dash.iter().sum::<f64>() < 1.0 {
        return vec![points.to_vec()];
    }
    let mut strokes = Vec::new();
    let (mut turn, mut left, mut stroke) = (0, dash[0], Vec::new());
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let mut done = 0.0;
        while done < length {
            let step = left.min(length - done);
            let along = |s: f64| [0, 1].map(|i| from[i] + (to[i] - from[i]) * s / length);
            if turn % 2 == 0 && step > 0.0 {
                if stroke.is_empty() {
                    stroke.push(along(done));
                }
                stroke.push(along(done + step));
            }
            done += step;
            left -= step;
            // A rest below a thousandth of a pixel is rounding, and would make the loop endless.
            if left < 1e-3 {
                strokes.push(std::mem::take(&mut stroke));
                turn = (turn + 1) % dash.len();
                left = dash[turn];
            } else if step < 1e-9 {
                break;
            }
        }
    }
    strokes.push(stroke);
    strokes.retain(|stroke| stroke.len() > 1);
    strokes
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::style::{BLACK, Color};

    #[test]
    fn dashes_fill_their_share_of_the_line() {
        let points = [[0.0, 0.0], [33.0, 0.0], [100.0, 0.0]];
        let drawn = |dash: &[f64]| -> (usize, f64) {
            let strokes = strokes(&points, dash);
            let length = |stroke: &Vec<Spot>| stroke[stroke.len() - 1][0] - stroke[0][0];
            (strokes.len(), strokes.iter().map(length).sum())
        };
        assert_eq!(drawn(&[]), (1, 100.0));
        let (count, length) = drawn(&[6.0, 4.0]);
        assert!(count == 10 && (length - 60.0).abs() < 1e-9);
        // A line that begins with a gap fills the gaps of another.
        let (count, length) = drawn(&[0.0, 6.0, 4.0, 0.0]);
        assert!(count == 10 && (length - 40.0).abs() < 1e-9);
    }

    #[test]
    fn a_dashed_line_is_one_shape() {
        let mut sheet = Sheet::new(100.0, 10.0);
        sheet.dashed(vec![[0.0, 0.0], [100.0, 0.0]], &[6.0, 4.0], 1.0, BLACK.mix(1.0));
        assert_eq!(sheet.shapes.len(), 1);
    }
}

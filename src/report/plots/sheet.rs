//! A drawing as a list of shapes, in units of one pixel at normal size, `y` downwards.

use plotters::style::RGBAColor;

/// A point of the sheet.
pub type Spot = [f64; 2];

/// One shape.
#[derive(Debug, Clone)]
pub enum Shape {
    /// A line through points.
    Path {
        /// The points.
        points: Vec<Spot>,
        /// The width of the line.
        width: f64,
        /// Its colour.
        colour: RGBAColor,
        /// Lengths of stroke and gap in turn; empty for a line in one.
        dash: Vec<f64>,
    },
    /// A filled polygon.
    Area {
        /// The corners.
        points: Vec<Spot>,
        /// Its colour.
        colour: RGBAColor,
    },
    /// A filled circle.
    Disc {
        /// The centre.
        at: Spot,
        /// The radius.
        radius: f64,
        /// Its colour.
        colour: RGBAColor,
    },
    /// A line of text.
    Text(Label),
    /// An image.
    Image(Image),
}

/// A rectangle of pixels.
#[derive(Debug, Clone)]
pub struct Image {
    /// Its upper left corner.
    pub at: Spot,
    /// Its width and height on the sheet.
    pub size: Spot,
    /// How many pixels stand in a row.
    pub columns: usize,
    /// Red, green and blue of each, row after row from the top.
    pub pixels: Vec<[u8; 3]>,
}

/// A line of text, centred in height on its place.
#[derive(Debug, Clone)]
pub struct Label {
    /// Where.
    pub at: Spot,
    /// What.
    pub text: String,
    /// The size of the em.
    pub size: f64,
    /// Its colour.
    pub colour: RGBAColor,
    /// Which part of the text stands at its place.
    pub align: Align,
    /// True if it runs upwards.
    pub upward: bool,
}

/// Which part of a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A drawing.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// Its width.
    pub width: f64,
    /// Its height.
    pub height: f64,
    /// Its shapes, from the back to the front.
    pub shapes: Vec<Shape>,
}

impl Sheet {
    /// An empty sheet.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, shapes: Vec::new() }
    }

    /// Draws a line through points; fewer than two draw nothing.
    pub fn path(&mut self, points: Vec<Spot>, width: f64, colour: RGBAColor) {
        self.dashed(points, &[], width, colour);
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

    /// Shows an image.
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

    /// Writes a line of text that runs upwards, its middle at the place.
    pub fn upward(&mut self, at: Spot, text: impl Into<String>, size: f64, colour: RGBAColor) {
        let (text, align) = (text.into(), Align::Middle);
        self.shapes.push(Shape::Text(Label { at, text, size, colour, align, upward: true }));
    }

    /// Draws a line in dashes: lengths of stroke and gap in turn, of which one at least is above 0. None draws it in one.
    pub fn dashed(&mut self, points: Vec<Spot>, dash: &[f64], width: f64, colour: RGBAColor) {
        if points.len() > 1 {
            let dash = dash.to_vec();
            self.shapes.push(Shape::Path { points, width, colour, dash });
        }
    }
}

/// The strokes of a line in dashes, for what can draw lines in one only.
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
            // A rest below a thousandth of a pixel is rounding, and would stall the loop.
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
        // One that begins with a gap fills what another leaves.
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

//! Figure: a sheet with its title, and the typeface that measures its words.

use crate::report::ReportError;
use crate::report::plots::legend::{self, LINE, LegendEntry};
use crate::report::plots::style::{DARK, GREY};
use drawing::font::{InvalidFont, Typeface, fit, wrapped};
use drawing::sheet::{Align, Sheet};

/// Size of notes.
const NOTE: f64 = 12.5;

/// Left edge of titles and panels.
pub const LEFT: f64 = 92.0;

/// Sheet with a title.
pub struct Figure {
    /// Typeface.
    pub face: Typeface,
    /// Sheet.
    pub sheet: Sheet,
    /// Maximum width of text.
    span: f64,
}

/// Legend of the series and notes, below the panels.
pub struct Foot<'a> {
    /// `y` of the sheet at its top.
    pub top: f64,
    /// Series.
    pub entries: &'a [LegendEntry],
    /// Notes, each on lines of its own.
    pub notes: &'a [String],
}

impl Figure {
    /// Makes a sheet of that size with a title and smaller text below it.
    pub fn new(
        name: &str,
        [width, height]: [f64; 2],
        span: f64,
        [title, words]: [&str; 2],
    ) -> Result<Self, ReportError> {
        let wrong = |error: InvalidFont| ReportError::Draw {
            figure: name.to_owned(),
            message: error.to_string(),
        };
        let (face, mut sheet) = (Typeface::load().map_err(wrong)?, Sheet::new(width, height));
        for (y, text, size, colour) in [(30.0, title, 20.0, DARK), (57.0, words, 13.0, GREY)] {
            sheet.text([LEFT, y], fit(&face, text, size, span), size, colour, Align::Start);
        }
        Ok(Self { face, sheet, span })
    }

    /// Makes a sheet of that width with a title, with the height that legend and notes need.
    pub fn with_foot(
        name: &str,
        width: f64,
        titles: [&str; 2],
        foot: &Foot,
    ) -> Result<Self, ReportError> {
        let span = width - LEFT - 18.0;
        let mut figure = Self::new(name, [width, 0.0], span, titles)?;
        figure.sheet.height = foot.notes_at(&figure) + foot.lines(&figure).len() as f64 * 19.0;
        Ok(figure)
    }

    /// Draws legend and notes.
    pub fn close(mut self, foot: &Foot) -> Sheet {
        let (notes_at, span, lines) = (foot.notes_at(&self), self.span, foot.lines(&self));
        let Self { face, sheet, .. } = &mut self;
        legend::draw(face, sheet, [LEFT, foot.top - 8.0], foot.entries, span);
        for (i, line) in lines.into_iter().enumerate() {
            let at = [LEFT, notes_at + i as f64 * 19.0 - LINE / 2.0 + 4.0];
            sheet.text(at, line, NOTE, GREY, Align::Start);
        }
        self.sheet
    }
}

impl Foot<'_> {
    /// Returns the notes in lines as wide as the figure.
    fn lines(&self, figure: &Figure) -> Vec<String> {
        let wrap = |note: &String| wrapped(&figure.face, note, NOTE, figure.span);
        self.notes.iter().flat_map(wrap).collect()
    }

    /// Returns the `y` of the sheet at the first note.
    fn notes_at(&self, figure: &Figure) -> f64 {
        self.top + legend::height(&figure.face, self.entries, figure.span)
    }
}

/// Returns the name of a case, with its medium if the name does not have it. The folder of a case is its problem.
pub fn subject(name: &str, medium: &str) -> String {
    if name.contains(medium) { name.to_owned() } else { format!("{name}  ·  medium {medium}") }
}

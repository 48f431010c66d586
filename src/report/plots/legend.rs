//! Legends, outside of the data: a table of series under a figure, and a line of keys over a panel.

use plotters::style::RGBAColor;

use crate::report::plots::style::{DARK, GREY, Marker, PAPER};
use drawing::font::{Typeface, fit};
use drawing::sheet::{Align, Sheet, Spot};

/// Height of one line of a legend.
pub const LINE: f64 = 22.0;
const SAMPLE: f64 = 44.0;
const SIZE: f64 = 13.5;
const GAP: f64 = 26.0;
const MAX_COLUMNS: usize = 8;

/// Entry of a legend.
#[derive(Debug, Clone)]
pub struct LegendEntry {
    /// Text.
    pub label: String,
    /// Line: dashes and width; `None` for none.
    pub line: Option<(&'static [f64], f64)>,
    /// Marker; `None` for none.
    pub marker: Option<Marker>,
    /// Colour of both.
    pub colour: RGBAColor,
}

impl LegendEntry {
    fn draw(&self, sheet: &mut Sheet, [x, y]: Spot, words: &str) {
        if let Some((dash, width)) = self.line {
            sheet.dashed(vec![[x, y], [x + SAMPLE - 8.0, y]], dash, width, self.colour);
        }
        if let Some(marker) = self.marker {
            marker.draw(sheet, [x + SAMPLE / 2.0 - 4.0, y], 4.6, self.colour);
        }
        sheet.text([x + SAMPLE, y], words, SIZE, DARK, Align::Start);
    }
}

/// Returns the number of lines of the legend, and beginning and width of each column: as many columns as fit, each as
/// wide as its widest entry.
fn layout(face: &Typeface, entries: &[LegendEntry], width: f64) -> (usize, Vec<[f64; 2]>) {
    let widths: Vec<f64> =
        entries.iter().map(|e| face.width(&e.label, SIZE) + SAMPLE + GAP).collect();
    let columns = |lines: usize| -> Vec<[f64; 2]> {
        let mut begin = 0.0;
        let column = |widths: &[f64]| {
            let wide = widths.iter().copied().fold(1.0, f64::max);
            begin += wide;
            [begin - wide, wide.min(width)]
        };
        widths.chunks(lines).map(column).collect()
    };
    let is_enough = |lines: &usize| {
        let columns = columns(*lines);
        columns.len() <= MAX_COLUMNS
            && columns.iter().map(|column| column[1]).sum::<f64>() <= width + GAP
    };
    let all = entries.len().max(1);
    let lines = (1..all).find(is_enough).unwrap_or(all);
    (lines, columns(lines))
}

/// Returns the height of a legend of this width.
pub fn height(face: &Typeface, entries: &[LegendEntry], width: f64) -> f64 {
    if entries.is_empty() { 0.0 } else { layout(face, entries, width).0 as f64 * LINE }
}

/// Draws the entries in columns, read downwards, with the first line's middle at the place.
pub fn draw(face: &Typeface, sheet: &mut Sheet, [x, y]: Spot, entries: &[LegendEntry], width: f64) {
    let (lines, columns) = layout(face, entries, width);
    for (i, entry) in entries.iter().enumerate() {
        let Some([begin, wide]) = columns.get(i / lines) else { continue };
        let at = [x + begin, y + (i % lines) as f64 * LINE];
        entry.draw(sheet, at, &fit(face, &entry.label, SIZE, wide - SAMPLE));
    }
}

/// Marker with its meaning, over a panel.
#[derive(Debug, Clone, Copy)]
pub struct MarkerKey {
    /// Marker.
    pub marker: Marker,
    /// True if it is hollow.
    pub is_hollow: bool,
    /// Meaning.
    pub words: &'static str,
}

/// Draws markers with words in one line that ends at the place.
pub fn keys(face: &Typeface, sheet: &mut Sheet, [right, y]: Spot, keys: &[MarkerKey]) {
    let mut x = right;
    for MarkerKey { marker, is_hollow, words } in keys.iter().rev() {
        sheet.text([x, y], *words, 12.5, GREY, Align::End);
        x -= face.width(words, 12.5) + 10.0;
        marker.draw(sheet, [x, y], 4.2, GREY);
        if *is_hollow {
            marker.fill(sheet, [x, y], 2.4, PAPER);
        }
        x -= 18.0;
    }
}

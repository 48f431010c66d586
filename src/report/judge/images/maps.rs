//! A sheet with a map for each channel of a judged stack, and a frame around each tile that fails.

use plotters::style::RGBAColor;

use crate::judge::images::Judgement;
use crate::judge::images::judgement::Tile;
use crate::record::Verdict;
use crate::report::plots::style::{DARK, GREY};
use drawing::font::{Typeface, fit};
use drawing::sheet::{Align, Image, Sheet, Spot};

/// Length of the longer side of a map on the sheet.
pub const MAX_SIDE: f64 = 480.0;
/// Distance of maps from each other and from the rim.
pub const GAP: f64 = 24.0;
/// Top of the maps.
pub const HEAD: f64 = 92.0;
/// Maximum number of frames: more hide what they frame.
const FRAMES: usize = 400;

/// Value and colour of the dots of a map.
pub struct Dots {
    /// Value of a dot without a tile.
    pub none: f64,
    /// Value of a dot from its value so far and from a tile that covers it.
    pub join: fn(f64, &Tile) -> f64,
    /// Colour of a value.
    pub colour: fn(f64) -> [u8; 3],
}

/// Places of the maps of all channels, side by side.
pub struct Maps<'a> {
    judgement: &'a Judgement,
    /// Length of a pixel on the sheet.
    scale: f64,
    /// Width and height of a map.
    pub size: [f64; 2],
}

impl<'a> Maps<'a> {
    /// Returns the places for a stack.
    pub fn new(judgement: &'a Judgement) -> Self {
        let size = judgement.size;
        let scale = MAX_SIDE / size.rows.max(size.columns) as f64;
        Self { judgement, scale, size: [size.columns, size.rows].map(|n| n as f64 * scale) }
    }

    /// Returns the right end of the gap behind the last map.
    pub fn end(&self) -> f64 {
        GAP + self.judgement.size.channels as f64 * (self.size[0] + GAP)
    }

    /// Writes name and verdict, facts and legend above the maps.
    pub fn head(&self, sheet: &mut Sheet, face: &Typeface, room: f64, words: [&str; 3]) {
        let [name, facts, legend] = words;
        for (y, text, em, colour) in [
            (24.0, format!("{name}: {}", self.judgement.verdict.word()), 16.0, DARK),
            (46.0, facts.to_owned(), 11.5, GREY),
            (64.0, legend.to_owned(), 11.5, GREY),
        ] {
            sheet.text([GAP, y], fit(face, &text, em, room), em, colour, Align::Start);
        }
    }

    /// Draws the map of each channel, with frames of this colour.
    pub fn draw(&self, sheet: &mut Sheet, frame: RGBAColor, dots: &Dots) {
        let [width, _] = self.size;
        for channel in 0..self.judgement.size.channels {
            let left = GAP + channel as f64 * (width + GAP);
            if self.judgement.size.channels > 1 {
                let middle = [left + 0.5 * width, HEAD - 9.0];
                sheet.text(middle, format!("channel {channel}"), 11.5, DARK, Align::Middle);
            }
            sheet.image(self.map(channel, [left, HEAD], dots));
            sheet.frame([left, HEAD], self.size, GREY);
            for tile in self.framed(channel) {
                let at =
                    [left + tile.column as f64 * self.scale, HEAD + tile.row as f64 * self.scale];
                let size = [tile.width, tile.height].map(|n| n as f64 * self.scale);
                sheet.frame(at, size, frame);
            }
        }
    }

    /// Returns the tiles of a channel that fail; of tiles within each other the smallest.
    fn framed(&self, channel: usize) -> Vec<&'a Tile> {
        let fails = |tile: &&Tile| tile.channel == channel && tile.verdict == Verdict::Fail;
        let mut framed: Vec<&Tile> = Vec::new();
        // The smallest come first.
        for tile in self.judgement.tiles.iter().filter(fails) {
            if framed.len() < FRAMES && !framed.iter().any(|inner| tile.contains(inner)) {
                framed.push(tile);
            }
        }
        framed
    }

    /// Returns the map of a channel, of the smallest tiles, which do not overlap.
    fn map(&self, channel: usize, at: Spot, dots: &Dots) -> Image {
        let (judgement, dot) = (self.judgement, dot(self.judgement));
        let columns = judgement.size.columns.div_ceil(dot);
        let mut shown = vec![dots.none; columns * judgement.size.rows.div_ceil(dot)];
        for tile in smallest(judgement).filter(|tile| tile.channel == channel) {
            for row in tile.row / dot..=(tile.row + tile.height - 1) / dot {
                for column in tile.column / dot..=(tile.column + tile.width - 1) / dot {
                    let value = &mut shown[row * columns + column];
                    *value = (dots.join)(*value, tile);
                }
            }
        }
        let pixels = shown.into_iter().map(dots.colour).collect();
        Image { at, size: self.size, columns, pixels }
    }
}

/// Returns the smallest tiles, which do not overlap.
pub fn smallest(judgement: &Judgement) -> impl Iterator<Item = &Tile> {
    judgement.tiles.iter().filter(|tile| tile.size == judgement.tile)
}

/// Returns the number of pixels in a row that share a dot of a map.
pub fn dot(judgement: &Judgement) -> usize {
    let longest = judgement.size.rows.max(judgement.size.columns) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a quotient of lengths
    let dot = (longest / MAX_SIDE).ceil() as usize;
    dot.max(1)
}

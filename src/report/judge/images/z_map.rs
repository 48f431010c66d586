//! `z-map.png`: how many standard errors each tile is off, in every channel.

use plotters::style::RGBAColor;

use crate::harness::record::Verdict;
use crate::judge::images::Judgement;
use crate::judge::images::judgement::Tile;
use crate::report::plots::font::{Typeface, fit};
use crate::report::plots::paint;
use crate::report::plots::sheet::{Align, Image, Sheet, Spot};
use crate::report::plots::style::{DARK, GREY, ink};
use crate::report::render::{colour, palette};

/// Colours end at ±5 standard errors.
const STRONGEST: f64 = 5.0;
/// The longer side of a map on the sheet.
pub(super) const LONGEST: f64 = 480.0;
/// The distance of maps from each other and from the rim.
pub(super) const GAP: f64 = 24.0;
/// The width of the bar of colours with its numbers.
const BAR: f64 = 76.0;
/// Where the maps begin.
pub(super) const HEAD: f64 = 92.0;
/// The most frames that are drawn: more hide what they frame.
pub(super) const FRAMES: usize = 400;

/// The map as a PNG file; `name` is that of the images.
///
/// # Errors
///
/// In words, where the painter gives up.
pub fn png(judgement: &Judgement, name: &str) -> Result<Vec<u8>, String> {
    let face = Typeface::load().map_err(|error| error.to_string())?;
    let (rgb, size) = paint::pixels_of(&compose(judgement, name, &face))?;
    palette::encode(&rgb, size).map_err(|error| error.to_string())
}

fn compose(judgement: &Judgement, name: &str, face: &Typeface) -> Sheet {
    let size = judgement.size;
    let scale = LONGEST / size.rows.max(size.columns) as f64;
    let [width, height] = [size.columns, size.rows].map(|n| n as f64 * scale);
    let across = size.channels as f64;
    let all = (GAP + across * (width + GAP) + BAR).max(560.0);
    let mut sheet = Sheet::new(all, HEAD + height.max(150.0) + 24.0);
    let room = all - 2.0 * GAP;
    for (y, text, em, colour) in [
        (24.0, format!("{name}: {}", judgement.verdict.word()), 16.0, DARK),
        (46.0, facts(judgement), 11.5, GREY),
        (64.0, "red: too bright, blue: too dark; a frame: it fails".to_owned(), 11.5, GREY),
    ] {
        sheet.text([GAP, y], fit(face, &text, em, room), em, colour, Align::Start);
    }
    for channel in 0..size.channels {
        let left = GAP + channel as f64 * (width + GAP);
        if size.channels > 1 {
            let middle = [left + 0.5 * width, HEAD - 9.0];
            sheet.text(middle, format!("channel {channel}"), 11.5, DARK, Align::Middle);
        }
        sheet.image(map(judgement, channel, [left, HEAD], [width, height]));
        border(&mut sheet, [left, HEAD], [width, height], GREY);
        let fails = |tile: &&Tile| tile.channel == channel && tile.verdict == Verdict::Fail;
        for tile in judgement.tiles.iter().filter(fails).take(FRAMES) {
            let at = [left + tile.column as f64 * scale, HEAD + tile.row as f64 * scale];
            border(&mut sheet, at, [tile.width, tile.height].map(|n| n as f64 * scale), DARK);
        }
    }
    bar(&mut sheet, GAP + across * (width + GAP), height.max(150.0));
    sheet
}

fn facts(judgement: &Judgement) -> String {
    let (counts, tile, dot) = (judgement.counts, judgement.tile, dot(judgement));
    let dots = if dot > tile {
        format!("; a dot shows the largest of {dot} × {dot} pixels")
    } else {
        String::new()
    };
    let reference = if judgement.comparison.is_some() { "reference" } else { "truth" };
    format!(
        "standard errors from the {reference}, {} passes, tiles of {tile} × {tile} pixels; {} of {} tiles of all \
         sizes fail{dots}",
        judgement.passes, counts.fail, counts.tiles
    )
}

/// How many pixels in a row share a dot of the map.
pub(super) fn dot(judgement: &Judgement) -> usize {
    let longest = judgement.size.rows.max(judgement.size.columns) as f64;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a quotient of lengths
    let dot = (longest / LONGEST).ceil() as usize;
    dot.max(1)
}

fn map(judgement: &Judgement, channel: usize, at: [f64; 2], size: [f64; 2]) -> Image {
    let dot = dot(judgement);
    let columns = judgement.size.columns.div_ceil(dot);
    let mut shown = vec![0.0_f64; columns * judgement.size.rows.div_ceil(dot)];
    let is_shown = |tile: &&Tile| tile.channel == channel && tile.size == judgement.tile;
    for tile in judgement.tiles.iter().filter(is_shown) {
        // What has no number differs where nothing should.
        let z = tile.z.unwrap_or(f64::INFINITY.copysign(tile.mean - tile.truth));
        for row in tile.row / dot..=(tile.row + tile.height - 1) / dot {
            for column in tile.column / dot..=(tile.column + tile.width - 1) / dot {
                let dot = &mut shown[row * columns + column];
                if z.abs() > dot.abs() {
                    *dot = z;
                }
            }
        }
    }
    let pixels = shown.iter().map(|z| colour::difference(&[z / STRONGEST])).collect();
    Image { at, size, columns, pixels }
}

pub(super) fn border(sheet: &mut Sheet, [left, top]: Spot, [width, height]: Spot, ink: RGBAColor) {
    let (right, low) = (left + width, top + height);
    sheet.path(vec![[left, top], [right, top], [right, low], [left, low], [left, top]], 1.0, ink);
}

/// What the colours mean.
fn bar(sheet: &mut Sheet, left: f64, height: f64) {
    let (high, low, steps) = (HEAD, HEAD + height, 49_u32);
    for step in 0..steps {
        let at = |i: u32| low + (high - low) * f64::from(i) / f64::from(steps);
        let [r, g, b] = colour::difference(&[2.0 * f64::from(step) / f64::from(steps - 1) - 1.0]);
        let (y, end) = (at(step), at(step + 1));
        let corners = vec![[left, y], [left + 18.0, y], [left + 18.0, end], [left, end]];
        sheet.area(corners, ink(r, g, b));
    }
    border(sheet, [left, high], [18.0, low - high], GREY);
    for (share, text) in
        [(0.0, "z ≥ 5"), (0.25, "2.5"), (0.5, "0"), (0.75, "−2.5"), (1.0, "z ≤ −5")]
    {
        let y = high + share * (low - high);
        sheet.path(vec![[left + 18.0, y], [left + 23.0, y]], 1.0, GREY);
        sheet.text([left + 27.0, y], text, 10.5, DARK, Align::Start);
    }
}

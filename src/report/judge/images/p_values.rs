//! `p-values.png`: the p-value of each tile, as a map and as a histogram.
//!
//! Source of both pictures: A. Jung, J. Hanika, C. Dachsbacher, *Detecting Bias in Monte Carlo Renderers using Welch's
//! t-test*, Journal of Computer Graphics Techniques 9 (2020). For two stacks the p-values are those of permutations,
//! which are exact for equal distributions; otherwise those of z by the normal distribution.

use super::maps::{Dots, GAP, HEAD, Maps, smallest};
use crate::judge::images::Judgement;
use crate::judge::images::judgement::{ComparisonMethod, Tile};
use crate::report::plots::style::{COLOURS, GREY, ink};
use crate::report::plots::{Axis, Panel};
use drawing::font::{Typeface, fit};
use drawing::sheet::{Align, Sheet};
use numeric::digits::counted;

/// Minimum and maximum number of bins of the histogram; between them one bin per ten tiles.
const BINS: [usize; 2] = [4, 20];
/// Width of the histogram with its numbers, and height of its panel.
const WIDTH: f64 = 420.0;
const HEIGHT: f64 = 260.0;
/// Largest p-value that is red on the map.
const SMALL: f64 = 1e-3;
/// Red of small p-values.
const RED: [u8; 3] = [0xB2, 0x18, 0x2B];
/// Colour of a tile without a p-value.
const NONE: [u8; 3] = [0xF3, 0xE8, 0xC8];

/// Returns the pictures on one sheet; `name` is that of the images.
pub fn compose(judgement: &Judgement, name: &str, face: &Typeface) -> Sheet {
    let maps = Maps::new(judgement);
    let all = maps.end() + WIDTH + GAP;
    let mut sheet = Sheet::new(all, HEAD + maps.size[1].max(HEIGHT + 84.0) + 24.0);
    let source = match judgement.comparison.as_ref().map(|finding| finding.method) {
        Some(ComparisonMethod::Permutation) => {
            "by permutations of the passes: uniform if both stacks have one distribution"
        }
        Some(_) => "bounds by signs of differences: rather too large",
        None => {
            "of z by the normal distribution: about uniform if all is well, with many values a tile"
        }
    };
    let facts = format!("p-values of tiles of {0} × {0} pixels, {source}", judgement.tile);
    let legend = "map: black to white, p from 0 to 1; red: p ≤ 0.001; a blue frame: the smallest tile that fails there. No pattern should be seen";
    maps.head(&mut sheet, face, all - 2.0 * GAP, [name, &facts, legend]);
    // Minimum of all pixels of a dot; a minimum ignores NaN.
    let join = |shown: f64, tile: &Tile| shown.min(tile.p.unwrap_or(f64::NAN));
    maps.draw(&mut sheet, COLOURS[0], &Dots { none: f64::NAN, join, colour });
    histogram(&mut sheet, judgement, face, maps.end());
    sheet
}

fn colour(p: f64) -> [u8; 3] {
    if p.is_nan() {
        return NONE;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 0 to 255
    let grey = (255.0 * p.clamp(0.0, 1.0)).round() as u8;
    if p <= SMALL { RED } else { [grey; 3] }
}

/// Returns the number of tiles in each bin.
fn counts(judgement: &Judgement) -> Vec<usize> {
    let values: Vec<f64> = smallest(judgement).filter_map(|tile| tile.p).collect();
    let bins = (values.len() / 10).clamp(BINS[0], BINS[1]);
    let mut counts = vec![0; bins];
    for p in values {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 0 to 20
        let bin = (p * bins as f64) as usize;
        counts[bin.min(bins - 1)] += 1;
    }
    counts
}

fn histogram(sheet: &mut Sheet, judgement: &Judgement, face: &Typeface, left: f64) {
    let counts = counts(judgement);
    let all: usize = counts.iter().sum();
    let bins = counts.len() as f64;
    let expected = all as f64 / bins;
    // Three standard deviations of a binomial count.
    let band = 3.0 * (expected * (1.0 - 1.0 / bins)).sqrt();
    let maximum = counts.iter().map(|&n| n as f64).fold(expected + band, f64::max).max(1.0);
    let axis = |title: &str, high| Axis { title: title.to_owned(), log: false, low: 0.0, high };
    let size = [WIDTH - 56.0, HEIGHT];
    let panel =
        Panel::at([left + 44.0, HEAD], size, axis("p-value", 1.0), axis("", 1.04 * maximum));
    let area = |ends: [f64; 2], [bottom, top]: [f64; 2]| ends.map(|p| (p, bottom, top));
    let usual = [(expected - band).max(0.0), expected + band];
    panel.band(sheet, area([0.0, 1.0], usual), ink(0xE0, 0xE0, 0xE0));
    for (bin, &count) in counts.iter().enumerate() {
        let ends = [bin as f64 + 0.05, bin as f64 + 0.95].map(|end| end / bins);
        panel.band(sheet, area(ends, [0.0, count as f64]), COLOURS[0]);
    }
    panel.line(sheet, [(0.0, expected), (1.0, expected)], (&[], 1.5, COLOURS[1]));
    panel.frame(sheet, "");
    for (line, text) in [
        format!(
            "{}; line and band: uniform, ± 3 standard deviations.",
            counted(all as u64, "tile")
        ),
        "Uniform: nothing was found. A peak at 0: tiles are off.".to_owned(),
        "A peak at 1: less noise than the variance says, or passes shared.".to_owned(),
    ]
    .into_iter()
    .enumerate()
    {
        let at = [left + 8.0, panel.bottom + 62.0 + 15.0 * line as f64];
        sheet.text(at, fit(face, &text, 10.5, WIDTH - 8.0), 10.5, GREY, Align::Start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_tell_small_p_values_and_missing_ones() {
        assert_eq!((colour(1e-4), colour(1.0), colour(f64::NAN)), (RED, [255; 3], NONE));
        assert_eq!(colour(0.5), [128; 3]);
    }
}

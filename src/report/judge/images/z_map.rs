//! `z-map.png`: bias of each tile in standard errors, in every channel.

use super::maps::{Dots, GAP, HEAD, Maps, dot};
use crate::judge::images::Judgement;
use crate::judge::images::judgement::Tile;
use crate::report::plots::style::DARK;
use crate::report::render::colour;
use drawing::font::Typeface;
use drawing::sheet::Sheet;

/// Number of standard errors at which colours end, to either side.
const MAX_Z: f64 = 5.0;
/// Width of the bar of colours with its numbers.
const BAR: f64 = 76.0;

/// Returns the map; `name` is that of the images.
pub fn compose(judgement: &Judgement, name: &str, face: &Typeface) -> Sheet {
    let maps = Maps::new(judgement);
    let height = maps.size[1].max(150.0);
    let all = (maps.end() + BAR).max(560.0);
    let mut sheet = Sheet::new(all, HEAD + height + 24.0);
    let legend = "red: too bright, blue: too dark; a frame: the smallest tile that fails there";
    maps.head(&mut sheet, face, all - 2.0 * GAP, [name, &facts(judgement), legend]);
    let join = |shown: f64, tile: &Tile| {
        // A tile without spread that differs from its truth has an infinite z.
        let z = tile.z.unwrap_or(f64::INFINITY.copysign(tile.mean - tile.truth));
        if z.abs() > shown.abs() { z } else { shown }
    };
    let colour = |z: f64| colour::difference(&[z / MAX_Z]);
    maps.draw(&mut sheet, DARK, &Dots { none: 0.0, join, colour });
    let marks = [(0.0, "z ≥ 5"), (0.25, "2.5"), (0.5, "0"), (0.75, "−2.5"), (1.0, "z ≤ −5")];
    colour::bar(&mut sheet, [maps.end(), HEAD], height, (1, &marks));
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
    let decided = if judgement.is_unjudged() {
        "they are not judged, see the verdict".to_owned()
    } else {
        format!("{} of {} tiles of all sizes fail", counts.fail, counts.tiles)
    };
    format!(
        "standard errors from the {reference}, {} passes, tiles of {tile} × {tile} pixels; {decided}{dots}",
        judgement.passes
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::images::{Claim, ImageOptions, Level, Size, Stack, judge};

    #[test]
    fn a_map_of_tiles_without_a_verdict_counts_none() {
        // Passes of coins, of variance 1/4.
        let size = Size { rows: 16, columns: 16, channels: 1 };
        let coins = (0..64 * 256_u64).map(|number| {
            // SplitMix64.
            let bits = number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            f64::from(u8::from(bits >> 63 == 0))
        });
        let values: Vec<f64> = coins.collect();
        let stack = Stack::new(64, size, values).expect("a stack");
        let facts_of = |variance: f64| {
            let variance = Some(Level::All(variance));
            let claim = Claim { variance, ..Claim::of_truth(Level::All(0.5)) };
            facts(&judge(&stack, &claim, &ImageOptions::default()).expect("a judgement"))
        };
        assert!(facts_of(0.1).contains("they are not judged"), "{}", facts_of(0.1));
    }
}

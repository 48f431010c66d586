//! Picture of all z-scores of a run: a histogram for means, variances and lookups, with the normal curve that correct
//! estimators give and the band that 99 of 100 bars keep.

use plotters::style::{Color, RGBAColor};

use crate::record::Score;
use crate::record::scores::{EDGE, Scores, WIDTH};
use crate::report::plots::style::{DARK, GREY, ink};
use crate::report::plots::{Axis, Panel};
use drawing::Sheet;
use numeric::digits::short;

const SIZE: [f64; 2] = [560.0, 132.0];
const LEFT: f64 = 46.0;
const TOP: f64 = 30.0;
const PITCH: f64 = SIZE[1] + 54.0;
const BAR: RGBAColor = ink(0x56, 0x9B, 0xC8);
/// Colour of a bar beyond the band, which is no failure by itself.
const FAR: RGBAColor = ink(0xE6, 0x8A, 0x00);

/// Returns the histograms, one below the other.
pub fn figure(all: &[Scores]) -> Sheet {
    let mut sheet = Sheet::new(LEFT + SIZE[0] + 12.0, TOP + PITCH * all.len() as f64 + 10.0);
    for (i, scores) in all.iter().enumerate() {
        let is_last = i + 1 == all.len();
        panel(&mut sheet, TOP + PITCH * i as f64, scores, is_last);
    }
    sheet
}

/// Returns the quantity of a score, in the plural.
fn name(score: Score) -> String {
    format!("{}s", score.quantity().trim_end_matches('s'))
}

fn panel(sheet: &mut Sheet, top: f64, scores: &Scores, is_last: bool) {
    let highest = |bin: &crate::record::scores::Bin| bin.count.max(bin.band[1]);
    let high = scores.bins.iter().map(highest).max().unwrap_or(1) as f64;
    let title = if is_last { "z: difference from theory in standard errors" } else { "" };
    let end = EDGE + WIDTH;
    let x = Axis { title: title.to_owned(), log: false, low: -end, high: end };
    let y = Axis { title: String::new(), log: false, low: 0.0, high: 1.1 * high.max(1.0) };
    let panel = Panel::at([LEFT, top], SIZE, x, y);
    panel.grid(sheet);
    // The outermost bins are drawn as wide as the others.
    let ends = |ends: [f64; 2]| ends.map(|z| z.clamp(-end, end));
    for bin in &scores.bins {
        let [low, high] = ends(bin.ends);
        let gap = 0.06 * WIDTH;
        let colour = if bin.is_usual() { BAR } else { FAR };
        let count = bin.count as f64;
        panel.band(sheet, [(low + gap, 0.0, count), (high - gap, 0.0, count)], colour);
        if let Some(spot) = panel.spot(low.midpoint(high), count) {
            sheet.tip(spot, tip(scores, bin));
        }
    }
    let band = scores.bins.iter().flat_map(|bin| {
        let [low, high] = bin.band.map(|count| count as f64);
        ends(bin.ends).map(|z| (z, low, high))
    });
    panel.band(sheet, band, GREY.mix(0.25));
    let all = scores.all as f64;
    let density = |z: f64| all * WIDTH * (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
    let curve = (-80..=80).map(|i| f64::from(i) * EDGE / 80.0).map(|z| (z, density(z)));
    panel.line(sheet, curve, (&[], 1.8, DARK));
    panel.frame(sheet, &format!("{} {}", scores.all, name(scores.score)));
}

fn tip(scores: &Scores, bin: &crate::record::scores::Bin) -> String {
    let [low, high] = bin.ends;
    let place = match (low.is_finite(), high.is_finite()) {
        (false, _) => format!("below {}", short(high, 3)),
        (_, false) => format!("above {}", short(low, 3)),
        _ => format!("from {} to {}", short(low, 3), short(high, 3)),
    };
    let (what, [minimum, maximum]) = (name(scores.score), bin.band);
    format!(
        "z {place}: {} of {} {what}; {} expected, usually {minimum} to {maximum}",
        bin.count,
        scores.all,
        short(bin.expected, 3)
    )
}

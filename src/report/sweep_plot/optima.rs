//! The best constant σ̂ of each series: a filled star where the figure of merit is largest, a hollow one where it reaches
//! 90 % of its limit.

use plotters::style::Color;

use crate::catalogue::digits::short;
use crate::harness::record::Best;
use crate::report::plots::font::Typeface;
use crate::report::plots::legend::{self, Key};
use crate::report::plots::series::Series;
use crate::report::plots::style::{Marker, PAPER, ink};
use crate::report::plots::{Panel, Sheet};

const RIM: plotters::style::RGBAColor = ink(0x22, 0x22, 0x22);

/// Whether a star is hollow: the figure of merit has no maximum there.
fn is_hollow(best: Option<&Best>) -> bool {
    best.is_some_and(|best| best.limit.is_some())
}

/// Marks the best σ̂ inside the sweep with a star and a thin line down to the axis, and says what the stars mean.
pub fn draw(face: &Typeface, sheet: &mut Sheet, panel: &Panel, series: &[Series]) {
    let (mut filled, mut hollow) = (false, false);
    for one in series {
        let Some(curve) = one.curve else { continue };
        let Some(best) = curve.optimum else { continue };
        let Some(spot) = panel.spot(best.x, best.fom).filter(|&spot| panel.holds(spot)) else {
            continue;
        };
        let drop = vec![spot, [spot[0], panel.bottom]];
        sheet.dashed(drop, &[1.5, 3.0], 1.2, one.style.colour.mix(0.8));
        Marker::Star.draw(sheet, spot, 9.0, RIM);
        if is_hollow(curve.best.as_ref()) {
            Marker::Star.fill(sheet, spot, 7.5, one.style.colour);
            Marker::Star.fill(sheet, spot, 4.6, PAPER);
            hollow = true;
        } else {
            Marker::Star.fill(sheet, spot, 6.5, one.style.colour);
            filled = true;
        }
    }
    let key = |is_hollow, words| Key { marker: Marker::Star, is_hollow, words };
    let keys: Vec<Key> = [
        filled.then(|| key(false, "predicted optimum")),
        hollow.then(|| key(true, "90 % of the limit")),
    ]
    .into_iter()
    .flatten()
    .collect();
    legend::keys(face, sheet, [panel.right, panel.top - 15.0], &keys);
}

/// Where there is no maximum, and where the best σ̂ lies outside the sweep, in words.
pub fn notes(series: &[Series]) -> Vec<String> {
    let found =
        || series.iter().filter_map(|one| Some((one, one.curve?, one.curve?.best.as_ref()?)));
    let limits: Vec<String> = found()
        .filter_map(|(one, _, best)| Some(format!("{}: {}", one.label, short(best.limit?, 4))))
        .collect();
    let mut notes = Vec::new();
    if !limits.is_empty() {
        notes.push(format!(
            "(c): figures of merit that rise with σ\u{302} to a limit and have no optimum; a hollow star is where one reaches 90 % of \
             it. The limits are {}",
            limits.join("; ")
        ));
    }
    let outside: Vec<String> = found()
        .filter(|(_, curve, _)| curve.optimum.is_none())
        .map(|(one, _, best)| {
            format!("{}: σ\u{302} = {} ({})", one.label, short(best.sampling, 4), best.kind)
        })
        .collect();
    if !outside.is_empty() {
        notes.push(format!("(c), best σ\u{302} outside of the panel: {}", outside.join("; ")));
    }
    notes
}

//! The best constant σ̂ of each series: a filled star where the figure of merit is largest, a hollow one where it reaches
//! 90 % of its limit.

use plotters::style::Color;

use crate::record::Best;
use crate::report::plots::font::Typeface;
use crate::report::plots::legend::{self, Key};
use crate::report::plots::series::Series;
use crate::report::plots::style::{Marker, PAPER, ink};
use crate::report::plots::{Panel, Sheet};
use numeric::digits::short;

const RIM: plotters::style::RGBAColor = ink(0x22, 0x22, 0x22);

/// Whether the star of a best σ̂ is hollow, for the figure of merit has no maximum there; `None` for no star.
fn is_hollow(best: Option<&Best>) -> Option<bool> {
    let is_drawn = |best: &Best| best.limit.is_some() || best.is_optimum();
    best.map_or(Some(false), |best| is_drawn(best).then_some(best.limit.is_some()))
}

/// Marks the best σ̂ inside the sweep with a star and a thin line down to the axis, and says what the stars mean.
pub fn draw(face: &Typeface, sheet: &mut Sheet, panel: &Panel, series: &[Series]) {
    let (mut filled, mut hollow) = (false, false);
    for one in series {
        let Some(curve) = one.curve else { continue };
        let Some(best) = curve.optimum else { continue };
        let Some(is_hollow) = is_hollow(curve.best.as_ref()) else { continue };
        let Some(spot) = panel.spot(best.x, best.fom).filter(|&spot| panel.holds(spot)) else {
            continue;
        };
        let drop = vec![spot, [spot[0], panel.bottom]];
        sheet.dashed(drop, &[1.5, 3.0], 1.2, one.style.colour.mix(0.8));
        Marker::Star.draw(sheet, spot, 9.0, RIM);
        if is_hollow {
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

/// Note on the best σ̂ that are shares of limits, or have no star.
pub fn note(series: &[Series]) -> Option<String> {
    let said = series.iter().filter_map(|one| {
        let curve = one.curve?;
        let best = curve.best.as_ref()?;
        let outside = if curve.optimum.is_none() { ", outside of the panel" } else { "" };
        let (label, at) = (&one.label, short(best.sampling, 4));
        match best.limit {
            Some(limit) => {
                let limit = short(limit, 4);
                let kind = &best.kind;
                Some(format!("{label} rises to {limit}, {kind} at σ\u{302} = {at}{outside}"))
            }
            None if outside.is_empty() && best.is_optimum() => None,
            None => Some(format!("{label}: {} at σ\u{302} = {at}{outside}", best.kind)),
        }
    });
    let said: Vec<String> = said.collect();
    (!said.is_empty()).then(|| format!("(c), best σ\u{302}: {}", said.join("; ")))
}

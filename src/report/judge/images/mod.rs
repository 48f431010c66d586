//! Results of `judge --images`: on the console, as a table of tiles, and as a picture.

pub mod console;
mod maps;
pub mod p_values;
pub mod z_map;

use crate::judge::images::Judgement;
use crate::judge::images::judgement::Tile;
use crate::record::Verdict;
use crate::report::fields::table;
use crate::report::{Artifact, ReportError};
use numeric::digits::exact;

/// Returns `judgement.json`, and `tiles.csv`, `z-map.png` and `p-values.png` if tiles were judged.
///
/// # Errors
///
/// An encoder or the painter fails.
pub fn artifacts(judgement: &Judgement, name: &str) -> Result<Vec<Artifact>, ReportError> {
    let json = serde_json::to_string_pretty(judgement)? + "\n";
    let mut files = vec![Artifact::text("judgement.json", json)];
    if !judgement.tiles.is_empty() {
        files.push(Artifact::text("tiles.csv", tiles(judgement)?));
        for (figure, png) in [
            ("z-map", z_map::png as fn(&Judgement, &str) -> Result<Vec<u8>, String>),
            ("p-values", p_values::png),
        ] {
            let draw = |message| ReportError::Draw { figure: figure.to_owned(), message };
            let bytes = png(judgement, name).map_err(draw)?;
            files.push(Artifact { path: format!("{figure}.png").into(), bytes });
        }
    }
    Ok(files)
}

const HEADER: [&str; 18] = [
    "size",
    "row",
    "column",
    "height",
    "width",
    "channel",
    "truth",
    "mean",
    "standard_error",
    "z",
    "p",
    "ln_e",
    "ln_p_above",
    "ln_p_below",
    "tolerance",
    "verdict",
    "fails_by_holm",
    "listed_by_e_bh",
];

/// Returns `tiles.csv`: every tile in each channel, with its verdict.
///
/// # Errors
///
/// The encoder fails.
fn tiles(judgement: &Judgement) -> Result<String, ReportError> {
    table("tiles", HEADER, judgement.tiles.iter().map(row))
}

fn row(tile: &Tile) -> [String; 18] {
    let optional = |x: Option<f64>| x.map(exact).unwrap_or_default();
    let is_failing = tile.verdict == Verdict::Fail;
    [
        tile.size.to_string(),
        tile.row.to_string(),
        tile.column.to_string(),
        tile.height.to_string(),
        tile.width.to_string(),
        tile.channel.to_string(),
        exact(tile.truth),
        exact(tile.mean),
        exact(tile.standard_error),
        optional(tile.z),
        optional(tile.p),
        exact(tile.ln_e),
        exact(tile.ln_p[0]),
        exact(tile.ln_p[1]),
        optional(tile.tolerance),
        tile.verdict.word().to_owned(),
        is_failing.to_string(),
        tile.is_listed.to_string(),
    ]
}

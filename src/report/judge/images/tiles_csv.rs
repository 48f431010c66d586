//! `tiles.csv`: every tile in each channel, with what is said of it.

use crate::judge::images::Judgement;
use crate::judge::images::judgement::Tile;
use crate::record::Verdict;
use crate::report::ReportError;
use crate::report::columns::table;
use numeric::digits::exact;

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

/// The table.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn csv(judgement: &Judgement) -> Result<String, ReportError> {
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

//! Results of `judge --images`: on the console, as a table of tiles, and as a picture.

pub mod console;
mod maps;
mod p_values;
mod record;
mod z_map;

use crate::judge::images::Judgement;
use crate::judge::images::judgement::Tile;
use crate::record::Verdict;
use crate::report::fields::{self, Table, table};
use crate::report::plots;
use crate::report::{Artifact, ReportError};

pub use record::{MEANINGS, json};

/// Returns `judgement.json`, and `tiles.csv`, `z-map.png` and `p-values.png` if tiles were judged.
pub fn artifacts(judgement: &Judgement, name: &str) -> Result<Vec<Artifact>, ReportError> {
    let mut files = vec![Artifact::text("judgement.json", json(judgement)?)];
    if !judgement.tiles.is_empty() {
        files.push(fields::artifact("tiles.csv", &<&Tile>::fields(), &judgement.tiles)?);
        files.push(plots::picture("z-map", |face| z_map::compose(judgement, name, face))?);
        files.push(plots::picture("p-values", |face| p_values::compose(judgement, name, face))?);
    }
    Ok(files)
}

table! {
    impl<'a> for &'a Tile {
        "size": "Size of tiles of its kind in pixels" = |tile| tile.size;
        "row": "Row of its first pixel, from 0" = |tile| tile.row;
        "column": "Column of its first pixel, from 0" = |tile| tile.column;
        "height": "Height in pixels" = |tile| tile.height;
        "width": "Width in pixels" = |tile| tile.width;
        "channel": "Number of the channel, from 0" = |tile| tile.channel;
        "truth": "Mean of the truth, or of the reference" = |tile| tile.truth;
        "mean": "Mean of the passes" = |tile| tile.mean;
        "standard_error": "Standard error of the mean" = |tile| tile.standard_error;
        "z": "Difference from the truth in standard errors" = |tile| tile.z;
        "p": "p-value of the tile" = |tile| tile.p;
        "ln_e": "Evidence against the truth: it fails at the limit" = |tile| tile.ln_e;
        "ln_p_above": "Evidence against a bias of +ε" = |tile| tile.ln_p[0];
        "ln_p_below": "Evidence against a bias of −ε" = |tile| tile.ln_p[1];
        "tolerance": "Tolerance ε, relative to the mean of the picture" = |tile| tile.tolerance;
        "needed_passes": "Number of passes after which an undecided tile would be decided; empty for others, and if no number of them suffices" = |tile| tile.needed.filter(|_| tile.verdict == Verdict::Inconclusive);
        "verdict": "Result" = |tile| tile.verdict.word();
        "fails_by_holm": "Whether it fails, at the error rate of all tiles together" = |tile| Some(tile.verdict == Verdict::Fail);
        "listed_by_e_bh": "Whether the list of suspects (e-BH) has it" = |tile| Some(tile.is_listed);
    }
}

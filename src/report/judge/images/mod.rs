//! What `judge --images` found: on the console, as a table of tiles, and as a picture.

pub mod console;
mod maps;
pub mod p_values;
pub mod tiles_csv;
pub mod z_map;

use crate::judge::images::Judgement;
use crate::report::{Artifact, ReportError};

/// `judgement.json`, and `tiles.csv`, `z-map.png` and `p-values.png` where tiles were judged.
///
/// # Errors
///
/// Where an encoder or the painter gives up.
pub fn artifacts(judgement: &Judgement, name: &str) -> Result<Vec<Artifact>, ReportError> {
    let json = serde_json::to_string_pretty(judgement)? + "\n";
    let mut files = vec![Artifact::text("judgement.json", json)];
    if !judgement.tiles.is_empty() {
        files.push(Artifact::text("tiles.csv", tiles_csv::csv(judgement)?));
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

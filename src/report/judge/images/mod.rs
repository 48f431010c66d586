//! What `judge --images` found: on the console, as a table of tiles, and as a picture.

pub mod console;
pub mod tiles_csv;
pub mod z_map;

use crate::judge::images::Judgement;
use crate::report::{Artifact, ReportError};

/// `judgement.json`, and `tiles.csv` and `z-map.png` where tiles were judged.
///
/// # Errors
///
/// Where an encoder or the painter gives up.
pub fn artifacts(judgement: &Judgement, name: &str) -> Result<Vec<Artifact>, ReportError> {
    let json = serde_json::to_string_pretty(judgement)? + "\n";
    let mut files = vec![Artifact::text("judgement.json", json)];
    if !judgement.tiles.is_empty() {
        files.push(Artifact::text("tiles.csv", tiles_csv::csv(judgement)?));
        let draw = |message| ReportError::Draw { figure: "z-map".to_owned(), message };
        let bytes = z_map::png(judgement, name).map_err(draw)?;
        files.push(Artifact { path: "z-map.png".into(), bytes });
    }
    Ok(files)
}

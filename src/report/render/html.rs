//! `gallery/report.html`: the sheets of all pictures, and their errors as a table.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::html;

use super::Joined;
use crate::render::PictureRecord;
use crate::report::fields::places;
use crate::report::html as page;
use crate::report::html::listing::{self, table};

/// Columns of the page, beside the picture.
const COLUMNS: [usize; 10] = places::<Joined, _>([
    "estimator",
    "sampling",
    "control",
    "rmse",
    "predicted_rmse",
    "mean_error",
    "lookups_per_pixel",
    "draws_per_pixel",
    "figure_of_merit",
    "reason",
]);

/// Returns a page of HTML with all pictures, each with its sheet as a PNG file.
pub fn text(pictures: &[(PictureRecord, Vec<u8>)]) -> String {
    let rows: Vec<Joined> = super::joined(pictures.iter().map(|(picture, _)| picture)).collect();
    let line = format!("{} pictures, {} images", pictures.len(), rows.len());
    let choices = [("group", pictures.iter().map(|(picture, _)| picture.name.clone()).collect())];
    let body = html! {
        header.run.refused {
            p.tool { "Trueflight " (env!("CARGO_PKG_VERSION")) ", estimators side by side" }
            h1 { (line) }
        }
        section aria-labelledby="experiments" {
            h2 #experiments { "Errors" }
            (listing::form(&choices, rows.len()))
            (table("picture", |of| ("", of.picture.name.clone()), &COLUMNS, &rows, |of| of.picture.name.clone()))
        }
        section aria-labelledby="sheets" {
            h2 #sheets { "Pictures" }
            @for (picture, sheet) in pictures {
                figure {
                    figcaption { b { (picture.name) } " " (picture.title) br; (picture.caption) }
                    img.sheet alt={ "The reference of " (picture.name)
                                    " and the image of each estimator, each with its error in false colour" }
                        src={ "data:image/png;base64," (STANDARD.encode(sheet)) };
                }
            }
        }
    };
    page::document(&format!("Trueflight: {line}"), &body)
}

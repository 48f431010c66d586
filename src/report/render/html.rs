//! `gallery/report.html`: the sheets of all pictures, and their errors as a table.

use crate::report::html::template::html;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::PictureImage;
use crate::render::PictureRecord;
use crate::report::fields::{Shown, shown};
use crate::report::html::listing::{page, section};

/// Columns of the page, beside the picture.
const COLUMNS: &[Shown] = shown!(PictureImage:
    "estimator", "sampling", "control", "rmse", "predicted_rmse", "mean_error", "lookups_per_pixel",
    "draws_per_pixel", "figure_of_merit", "reason"
);

/// Returns a page of HTML with all pictures, each with its sheet as a PNG file.
pub fn text(pictures: &[(PictureRecord, Vec<u8>)]) -> String {
    let rows: Vec<PictureImage> =
        super::joined(pictures.iter().map(|(picture, _)| picture)).collect();
    let line = format!("{} pictures, {} images", pictures.len(), rows.len());
    let name = |of: &PictureImage| of.picture.name.clone();
    let sections = html! {
        (section("Errors", "picture", |of| ("", of.picture.name.clone()), COLUMNS, &rows, name))
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
    page("estimators side by side", ("refused", &line), &html! {}, &sections)
}

//! `gallery/report.html`: the sheets of all pictures, and their errors as a table.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::html;

use crate::render::PictureRecord;
use crate::render::record::{Exposure, ExposureRecord};
use crate::report::fields::{Field, fields};
use crate::report::html as page;
use crate::report::html::listing::{self, table};

/// Image with its picture.
type Joined<'a> = (&'a PictureRecord, &'a ExposureRecord);

/// Returns the columns of the page, beside the picture.
fn columns<'a>() -> Vec<Field<Joined<'a>>> {
    fn of(exposure: &ExposureRecord, figure: fn(&Exposure) -> Option<f64>) -> Option<f64> {
        exposure.outcome.as_ref().ok().and_then(figure)
    }
    fields! {
        "estimator": "Estimator with its settings" = |(_, one)| one.estimator.to_string();
        "sampling" ["σ̂", "", Plain]: "Sampling extinction σ̂" = |(_, one)| &one.sampling;
        "control": "Control extinction" = |(_, one)| &one.control;
        "rmse" ["RMSE", "", Short(3)]: "Root mean squared difference from the reference" = |(_, one)| of(one, |found| Some(found.rmse));
        "predicted_rmse" ["in theory", "", Short(3)]: "The same in theory" = |(_, one)| of(one, |found| found.predicted_rmse);
        "mean_error" ["mean error", "", Short(3)]: "Mean difference from the reference" = |(_, one)| of(one, |found| Some(found.bias));
        "lookups_per_pixel" ["lookups/pixel", "", Short(3)]: "Lookups of σ_t for a pixel" = |(_, one)| of(one, |found| Some(found.lookups));
        "draws_per_pixel" ["draws/pixel", "", Short(3)]: "Draws of a pixel" = |(_, one)| of(one, |found| Some(found.draws));
        "figure_of_merit" ["1/(MSE · lookups)", "", Short(3)]: "Figure of merit: larger is better" = |(_, one)| of(one, |found| found.figure_of_merit);
        "reason" ["refused", "", Plain]: "Reason why there is no image" = |(_, one)| reason(one);
    }
}

fn reason(exposure: &ExposureRecord) -> &str {
    exposure.outcome.as_ref().err().map_or("", String::as_str)
}

/// Returns a page of HTML with all pictures, each with its sheet as a PNG file.
pub fn text(pictures: &[(PictureRecord, Vec<u8>)]) -> String {
    let rows: Vec<Joined> = pictures
        .iter()
        .flat_map(|(picture, _)| picture.exposures.iter().map(move |exposure| (picture, exposure)))
        .collect();
    let fields = columns();
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
            (table("picture", |(picture, _)| ("", picture.name.clone()), &fields.iter().collect::<Vec<_>>(), &rows, |(picture, _)| picture.name.clone()))
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

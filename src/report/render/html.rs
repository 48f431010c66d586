//! `gallery/report.html`: the sheets of all pictures, and their errors as a table.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::html;

use crate::render::PictureRecord;
use crate::render::record::{Exposure, ExposureRecord};
use crate::report::html as page;
use crate::report::html::listing::{self, Cell, Column, table};

/// Image with its picture.
type Joined<'a> = (&'a PictureRecord, &'a ExposureRecord);

/// Makes a column for a figure of an image.
macro_rules! exposed {
    ($title:literal, $figure:expr) => {
        Column {
            title: $title,
            cell: Cell::Number(|(_, exposure)| {
                let figure: fn(&Exposure) -> Option<f64> = $figure;
                exposure.outcome.as_ref().ok().and_then(figure)
            }),
        }
    };
}

fn columns<'a>() -> [Column<Joined<'a>>; 11] {
    [
        Column { title: "picture", cell: Cell::Text(|(picture, _)| picture.name.clone()) },
        Column { title: "estimator", cell: Cell::Text(|(_, one)| one.estimator.to_string()) },
        Column { title: "σ\u{302}", cell: Cell::Text(|(_, one)| one.sampling.clone()) },
        Column { title: "control", cell: Cell::Text(|(_, one)| one.control.clone()) },
        exposed!("RMSE", |found| Some(found.rmse)),
        exposed!("in theory", |found| found.predicted_rmse),
        exposed!("mean error", |found| Some(found.bias)),
        exposed!("lookups/pixel", |found| Some(found.lookups)),
        exposed!("draws/pixel", |found| Some(found.draws)),
        exposed!("1/(MSE · lookups)", |found| found.figure_of_merit),
        Column { title: "refused", cell: Cell::Text(|(_, one)| reason(one).to_owned()) },
    ]
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
            (table(&columns(), &rows, |_| "", |(picture, _)| picture.name.clone()))
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

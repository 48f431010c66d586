//! Parts of plots.
//!
//! A figure is composed as a [`Sheet`], a list of shapes without a file format, and the sheet is then painted twice: as
//! SVG and as PNG. Both show the same drawing.

pub mod axis;
pub mod figure;
pub mod legend;
pub mod overlap;
pub mod panel;
pub mod series;
pub mod style;
pub mod svg;
pub mod z_panel;

use crate::report::{Artifact, ReportError, case_path};
use drawing::font::Typeface;
use drawing::{Sheet, paint, palette};

pub use axis::Axis;
pub use panel::Panel;

/// Returns the figure of a case in both formats, as `CASE.svg` and `CASE.png` for the ending `""`, or
/// `CASE.anatomy.svg` and so on for the ending `"anatomy."`.
pub fn artifacts(case: &str, ending: &str, sheet: &Sheet) -> Result<Vec<Artifact>, ReportError> {
    let wrong = |message| ReportError::Draw { figure: format!("{case} {ending}"), message };
    let png = paint::png(sheet).map_err(wrong)?;
    Ok(vec![
        Artifact {
            path: case_path(case, &format!("{ending}svg")),
            bytes: svg::document(sheet).into_bytes(),
        },
        Artifact { path: case_path(case, &format!("{ending}png")), bytes: png },
    ])
}

/// Returns a sheet as the file `NAME.png`, with a palette where its colours are few.
pub fn picture(
    name: &str,
    compose: impl FnOnce(&Typeface) -> Sheet,
) -> Result<Artifact, ReportError> {
    let wrong = |message| ReportError::Draw { figure: name.to_owned(), message };
    let face = Typeface::load().map_err(|error| wrong(error.to_string()))?;
    let bytes = palette::png(&compose(&face)).map_err(wrong)?;
    Ok(Artifact { path: format!("{name}.png").into(), bytes })
}

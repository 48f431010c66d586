//! Parts of plots.
//!
//! A figure is composed as a [`Sheet`], a list of shapes without a file format, and the sheet is then painted twice: as
//! SVG and as PNG. Both show the same drawing.

pub mod axis;
pub mod figure;
pub mod font;
pub mod legend;
pub mod overlap;
pub mod paint;
pub mod panel;
pub mod series;
pub mod sheet;
pub mod style;
pub mod svg;
pub mod z_panel;

use crate::report::{Artifact, ReportError, case_path};

pub use axis::Axis;
pub use panel::Panel;
pub use sheet::Sheet;

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

//! The plots of the cases, each once in the page and shown wherever it is wanted.

use maud::{Markup, html};

use super::drawing;
use crate::record::{CaseRecord, Record};
use crate::report::plots::Sheet;
use crate::report::{ReportError, anatomy_plot, sweep_plot};

/// A plot that the page defines.
pub struct Plot {
    /// Its place in the page.
    id: String,
    /// What it shows, for those who do not see it.
    label: String,
    view: String,
    shapes: Markup,
}

/// The plots of every case, in the cases' order.
///
/// # Errors
///
/// Where a painter gives up.
pub fn all(record: &Record) -> Result<Vec<Vec<Plot>>, ReportError> {
    let cases = record.results.cases.iter().enumerate();
    cases.map(|(place, case)| of_case(place, case, record.results.seed)).collect()
}

fn of_case(place: usize, case: &CaseRecord, seed: u64) -> Result<Vec<Plot>, ReportError> {
    let mut plots = Vec::new();
    if let Some(sweep) = &case.sweep {
        let what =
            format!("{}: variance, cost, efficiency and z-scores along {}", case.name, sweep.axis);
        plots.push(plot(format!("sweep-{place}"), what, &sweep_plot::figure(case, sweep, seed)?));
    }
    if let Some(anatomy) = &case.anatomy {
        let what = format!(
            "{}: the medium along the ray, and the transmittance with its estimates",
            case.name
        );
        plots.push(plot(format!("ray-{place}"), what, &anatomy_plot::figure(case, anatomy)?));
    }
    Ok(plots)
}

/// A plot of a sheet.
pub fn plot(id: String, label: String, sheet: &Sheet) -> Plot {
    Plot { id, label, view: drawing::view(sheet), shapes: drawing::shapes(sheet) }
}

impl Plot {
    /// The plot, as large as its place allows.
    pub fn show(&self) -> Markup {
        html! {
            div.wide tabindex="0" role="group" aria-label="plot" {
                svg.plot viewBox=(self.view) role="img" aria-label=(self.label) {
                    use href={ "#" (self.id) } {}
                }
            }
        }
    }
}

/// The shapes of all plots, shown nowhere.
pub fn definitions(plots: &[Vec<Plot>]) -> Markup {
    html! {
        svg.hidden aria-hidden="true" focusable="false" {
            @for plot in plots.iter().flatten() {
                symbol id=(plot.id) viewBox=(plot.view) fill="none" { (plot.shapes) }
            }
        }
    }
}

//! `report.html`: the whole record as one page that needs no network and no other file.
//!
//! First come the verdict and pictures of all experiments, then what does not pass, the changes since a stored run, the
//! cases with their plots, and a table of all experiments with details that open. Only filters, sorting and the values of
//! plots need JavaScript. All text of a record goes through the template's escapes, so that a title cannot contain markup.

mod cases;
mod details;
mod experiments;
mod failing;
mod first;
mod map;
mod scores;
mod sparks;

use crate::report::html::template::html;

use crate::record::{CaseRecord, Record};
use crate::report::fields::Table;
use crate::report::html as page;
use crate::report::html::drawing::{self, Plot, plot};
use crate::report::run::summary_csv::SummaryRow;
use crate::report::run::{anatomy_plot, diff, sweep_plot, totals};
use crate::report::{Artifact, ReportError};

/// Returns the record as a page.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![Artifact::text("report.html", text(record)?)])
}

/// Returns the record as a page of HTML.
pub fn text(record: &Record) -> Result<String, ReportError> {
    let plots = plots(record)?;
    let title = format!("Trueflight: {}", totals::verdict(record).words());
    let shown = details::SharedContent {
        seed: record.results.seed,
        plots: &plots,
        fields: SummaryRow::fields(),
    };
    let body = html! {
        (drawing::definitions(&plots))
        (first::section(record))
        @if let Some(comparison) = &record.comparison { (diff::changes(comparison).section()) }
        (cases::section(record, &plots))
        (experiments::section(record, &shown))
        (experiments::legend(record, &shown))
        (first::facts(record))
    };
    Ok(page::document(&title, &body))
}

/// Returns the plots of every case, in the cases' order.
fn plots(record: &Record) -> Result<Vec<Vec<Plot>>, ReportError> {
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

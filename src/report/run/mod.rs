//! Reports of a run: a report is one file here and one line in a list at the foot of this page.

pub mod anatomy_plot;
pub mod annotations;
pub mod case_csv;
pub mod changes_csv;
pub mod checks_csv;
pub mod console;
pub mod diff;
pub mod failures;
pub mod fields;
pub mod html;
pub mod junit;
pub mod markdown;
mod reasons;
pub mod record_json;
pub mod summary_csv;
pub mod sweep_plot;
pub mod totals;

use crate::record::Record;
use crate::report::{Artifact, ReportError};
use media::catalogue::{Page, Registry};
use media::{page, registry};

/// Renders a report's files from a record.
pub type Report = fn(&Record) -> Result<Vec<Artifact>, ReportError>;

/// Renders every report that a run writes.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let rendered: Result<Vec<_>, _> =
        CATALOGUE.values.iter().map(|render| render(record)).collect();
    Ok(rendered?.into_iter().flatten().collect())
}

/// Every report that a run writes, in the order of registration.
pub static CATALOGUE: Registry<Report> = registry![
    summary_csv::render,
    checks_csv::render,
    case_csv::render,
    changes_csv::render,
    sweep_plot::render,
    anatomy_plot::render,
    record_json::render,
    html::render,
];

/// Pages of the reports that are written only if an option asks for them.
pub const OPTIONAL: &[Page] = &[page!(junit), page!(markdown), page!(annotations)];

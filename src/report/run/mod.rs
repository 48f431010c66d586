//! Reports of a run: a report is one file here and one line in the list at the foot of this page.

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
use media::catalogue::PageList;

/// Renders a report's files from a record.
pub type Report = fn(&Record) -> Result<Vec<Artifact>, ReportError>;

/// Renders every report that a run writes.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let rendered: Result<Vec<_>, _> = REPORTS.iter().map(|render| render(record)).collect();
    Ok(rendered?.into_iter().flatten().collect())
}

/// Lists the reports: each line gives the module and its entries in both lists below. Reports after the semicolon are
/// written only if an option asks for them.
macro_rules! reports {
    ($($module:ident,)*; $($asked:ident,)*) => {
        /// Every page, in the order of registration.
        pub const CATALOGUE: PageList =
            PageList { name: "reports", pages: &[$(media::page!($module),)* $(media::page!($asked)),*] };

        /// Every report that a run writes, in the same order.
        pub const REPORTS: &[Report] = &[$($module::render),*];
    };
}

reports! {
    summary_csv,
    checks_csv,
    case_csv,
    changes_csv,
    sweep_plot,
    anatomy_plot,
    record_json,
    html,
    ;
    junit,
    markdown,
    annotations,
}

//! What a bench found, as a table on the screen, files and plots.
//!
//! ```text
//! bench.csv        one row per experiment and channel: times, ratios, efficiencies
//! report.html      all of it as a page
//! CASE.error.csv   the measured error against draws, lookups and time, with what theory expects
//! CASE.svg, .png   the same as a log-log plot
//! ```

pub mod console;
pub mod diff;
pub mod html;
pub mod plot;
pub mod tables;

use crate::bench::record::{Bench, BenchCase};
use crate::report::{Artifact, ReportError};

/// Every file of a bench.
///
/// # Errors
///
/// Where an encoder or a painter gives up.
pub fn render(bench: &Bench) -> Result<Vec<Artifact>, ReportError> {
    let mut artifacts = vec![
        Artifact::text("bench.csv", tables::csv(bench)?),
        Artifact::text("report.html", html::text(bench)?),
    ];
    for case in plotted(bench) {
        artifacts.push(tables::errors(case)?);
        artifacts.extend(plot::artifacts(bench, case)?);
    }
    Ok(artifacts)
}

/// The cases whose errors are plotted.
pub(super) fn plotted(bench: &Bench) -> impl Iterator<Item = &BenchCase> {
    bench.cases.iter().filter(|case| case.rows.iter().any(|row| !row.curve.is_empty()))
}

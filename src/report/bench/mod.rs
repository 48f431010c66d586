//! Results of a bench as a table on the screen, files and plots.
//!
//! ```text
//! bench.csv        one row per experiment and channel: times, ratios, efficiencies
//! report.html      everything as a page
//! changes.csv      changes since a stored bench, if there is one
//! CASE.error.csv   the measured error against draws, lookups and time, with the predicted one
//! CASE.svg, .png   the errors as a log-log plot
//! ```

pub mod console;
pub mod diff;
pub mod html;
pub mod plot;
pub mod tables;

use crate::bench::record::{Bench, BenchCase};
use crate::report::{Artifact, ReportError};

/// Returns every file of a bench.
pub fn render(bench: &Bench) -> Result<Vec<Artifact>, ReportError> {
    let mut artifacts = vec![
        Artifact::text("bench.csv", tables::csv(bench)?),
        Artifact::text("report.html", html::text(bench)?),
    ];
    if let Some(comparison) = &bench.comparison {
        artifacts.push(diff::changes(comparison).artifact()?);
    }
    for case in plotted(bench) {
        artifacts.push(tables::errors(case)?);
        artifacts.extend(plot::artifacts(bench, case)?);
    }
    Ok(artifacts)
}

/// Returns the cases with errors to plot.
pub(super) fn plotted(bench: &Bench) -> impl Iterator<Item = &BenchCase> {
    bench.cases.iter().filter(|case| case.rows.iter().any(|row| !row.curve.is_empty()))
}

//! `summary.csv`: every experiment and channel of the run on one line, results and timing joined.

use crate::record::Record;
use crate::report::{Artifact, ReportError, rows};

/// One row per experiment and channel.
///
/// # Errors
///
/// Where an encoder or a painter gives up.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![Artifact::text("summary.csv", rows::csv(record)?)])
}

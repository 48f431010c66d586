//! `changes.csv`: changes since a stored run, one line each; only of a run with a baseline.

use crate::record::Record;
use crate::report::run::diff;
use crate::report::{Artifact, ReportError};

/// Returns the table of changes, if the run was compared with a stored one.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    record.comparison.iter().map(|comparison| diff::changes(comparison).artifact()).collect()
}

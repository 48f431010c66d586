//! `summary.csv`: every experiment and channel of the run on one line, results and timing joined.

use std::path::PathBuf;

use crate::harness::record::Record;
use crate::report::{Artifact, Report, ReportError, rows};

/// One row per experiment and channel.
pub struct SummaryCsv;

impl Report for SummaryCsv {
    fn render(&self, record: &Record) -> Result<Vec<Artifact>, ReportError> {
        let text = rows::csv(record)?;
        Ok(vec![Artifact { path: PathBuf::from("summary.csv"), bytes: text.into_bytes() }])
    }
}

//! `record.json`: the whole record, for machines.
//!
//! One object: `schema` (the version of the form), `results` (the same for any number of threads on
//! any machine), `timing`, and the `comparison` with a stored run or `null`. JSON has no infinite numbers: where one stands in the record, as in a
//! variance without bound or in evidence beyond measure, the file has `null`, as for what is unknown.

use serde::Serialize;

use crate::baseline::Comparison;
use crate::harness::record::{Record, Results, Timing};
use crate::report::{Artifact, ReportError};

/// The record as one JSON object.
///
/// # Errors
///
/// Where an encoder or a painter gives up.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![Artifact::text("record.json", text(record)?)])
}

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    results: &'a Results,
    timing: &'a Timing,
    comparison: Option<&'a Comparison>,
}

/// The record as JSON.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn text(record: &Record) -> Result<String, ReportError> {
    let Record { results, timing, comparison } = record;
    let comparison = comparison.as_ref();
    let document = Document { schema: results.schema, results, timing, comparison };
    Ok(serde_json::to_string(&document)? + "\n")
}

//! `record.json`: the whole record, for machines.
//!
//! One object: `schema` (the version of the form), `results` (the same for any number of threads on
//! any machine), `timing`, and the `comparison` with a stored run or `null`. JSON has no infinite numbers: where one stands in the record, as in a
//! variance without bound or in evidence beyond measure, the file has `null`, as for what is unknown.

use serde::{Deserialize, Serialize};

use crate::record::baseline::Comparison;
use crate::record::{Record, Results, SCHEMA, Timing};
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

/// Why a text is no record that can be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UnreadableRecord {
    /// It is of another version of the form.
    #[error("a record of form {found}, this program reads {SCHEMA}")]
    Schema {
        /// Its form.
        found: u64,
    },
    /// It is not what this program writes.
    #[error("not a record, or a broken one ({0})")]
    Broken(#[from] serde_json::Error),
}

/// The record that a text is of. What is `null` there for not being finite is NaN, evidence ∞, and unknown
/// where a number may be.
///
/// # Errors
///
/// It is another version's, or no record.
pub fn read(text: &[u8]) -> Result<Record, UnreadableRecord> {
    #[derive(Deserialize)]
    struct Form {
        schema: u64,
    }
    // The form is asked first: what else is there depends on it.
    let Form { schema: found } = serde_json::from_slice(text)?;
    if found == u64::from(SCHEMA) {
        Ok(serde_json::from_slice(text)?)
    } else {
        Err(UnreadableRecord::Schema { found })
    }
}

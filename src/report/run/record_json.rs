//! `record.json`: the whole record, for machines.
//!
//! The file is one object: `schema` (the version of the format), `results` (the same for any number of threads on any
//! machine), `timing`, and the `comparison` with a stored run or `null`. `results` is a tree: `cases`, each with its
//! `experiments`, each with its `channels`. An experiment has its identity `id`, of `case`, `problem`, `estimator`,
//! `sampling`, `control`, `swept` and `namesake`; `timing.experiments` has the times of each `id`. Unknown numbers are
//! `null`; numbers that may be infinite are then the words `inf`, `-inf` or `nan`.

use std::collections::BTreeMap;

use serde::de::Error;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::plan::ExperimentId;
use crate::record::baseline::Comparison;
use crate::record::{Record, Results, SCHEMA, Spent, Timing};
use crate::report::{Artifact, ReportError};

/// Returns the record as one JSON object.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![Artifact::text("record.json", text(record)?)])
}

/// Document, with the results as a reference or as a value.
#[derive(Serialize, Deserialize)]
struct Document<R> {
    schema: u32,
    results: R,
    timing: Times,
    comparison: Option<Comparison>,
}

#[derive(Serialize, Deserialize)]
struct Times {
    #[serde(flatten)]
    run: Timing,
    experiments: Vec<Time>,
}

/// Time of an experiment.
#[derive(Serialize, Deserialize)]
struct Time {
    id: ExperimentId,
    seconds: Option<f64>,
    reused: bool,
}

/// Returns the record as JSON.
pub fn text(record: &Record) -> Result<String, ReportError> {
    let Record { results, timing, comparison } = record;
    let experiments = results.cases.iter().flat_map(|case| &case.experiments);
    let times = experiments.map(|experiment| {
        let Spent { seconds, is_reused: reused } = experiment.spent;
        Time { id: experiment.id.clone(), seconds, reused }
    });
    let timing = Times { run: timing.clone(), experiments: times.collect() };
    let comparison = comparison.clone();
    let document = Document { schema: results.schema, results, timing, comparison };
    Ok(serde_json::to_string(&document)? + "\n")
}

/// Reason why a text cannot be read as a record.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UnreadableRecord {
    /// Another version of the format.
    #[error("a record of form {actual}, this program reads {SCHEMA}")]
    Schema {
        /// Version of the text.
        actual: u64,
    },
    /// The text is not a record.
    #[error("not a record, or a broken one ({0})")]
    Broken(#[from] serde_json::Error),
}

/// Reads a record.
///
/// # Errors
///
/// The text is of another version, or not a record.
pub fn read(text: &[u8]) -> Result<Record, UnreadableRecord> {
    let tree: Value = serde_json::from_slice(text)?;
    // The version is read first: everything else depends on it.
    let schema = tree.get("schema").ok_or_else(|| serde_json::Error::missing_field("schema"))?;
    let actual = u64::deserialize(schema)?;
    if actual != u64::from(SCHEMA) {
        return Err(UnreadableRecord::Schema { actual });
    }
    let document: Document<Results> = serde_json::from_value(tree)?;
    let Document { mut results, timing, comparison, .. } = document;
    let times: BTreeMap<ExperimentId, Spent> = timing
        .experiments
        .into_iter()
        .map(|Time { id, seconds, reused }| (id, Spent { seconds, is_reused: reused }))
        .collect();
    for case in &mut results.cases {
        for experiment in &mut case.experiments {
            experiment.spent = times.get(&experiment.id).copied().unwrap_or_default();
        }
    }
    Ok(Record { results, timing: timing.run, comparison })
}

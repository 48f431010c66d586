//! `CASE.error.csv`: the measured error of each experiment and channel against its price.

use crate::bench::record::BenchCase;
use crate::report::number::exact;
use crate::report::rows::table;
use crate::report::{Artifact, ReportError, case_path};

const HEADER: [&str; 14] = [
    "estimator",
    "sampling",
    "control",
    "channel",
    "swept",
    "draws",
    "lookups",
    "seconds",
    "plain_seconds",
    "error",
    "relative_error",
    "relative_error_least",
    "relative_error_most",
    "predicted_relative_error",
];

/// One line per row of the case and point of its curve.
pub(super) fn artifact(case: &BenchCase) -> Result<Artifact, ReportError> {
    let mut lines = Vec::new();
    for row in &case.rows {
        let Some(times) = &row.times else { continue };
        let priced = row.curve.iter().zip(&times.seconds).zip(&times.plain_seconds);
        for ((point, &seconds), &plain_seconds) in priced {
            let known = |x: Option<f64>| x.map(exact).unwrap_or_default();
            lines.push([
                row.estimator.clone(),
                row.sampling.map_or_else(|| row.sampling_kind.clone(), exact),
                row.control.clone(),
                row.channel.clone(),
                known(row.swept),
                point.draws.to_string(),
                exact(point.lookups),
                exact(seconds),
                exact(plain_seconds),
                exact(point.error),
                exact(point.relative),
                exact(point.least),
                exact(point.most),
                known(point.predicted),
            ]);
        }
    }
    let text = table(&case.name, HEADER, lines)?;
    Ok(Artifact { path: case_path(&case.name, "error.csv"), bytes: text.into_bytes() })
}

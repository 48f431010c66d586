//! `CASE.error.csv`: the measured error of each experiment and channel against its price.

use crate::bench::record::{BenchCase, BenchRow, CurvePoint};
use crate::report::columns::{self, Cell, Column, columns};
use crate::report::{Artifact, ReportError};

/// A point of a curve with its price.
struct Priced<'a> {
    row: &'a BenchRow,
    point: CurvePoint,
    seconds: f64,
    plain_seconds: f64,
}

/// The columns of the file.
fn columns<'a>() -> Vec<Column<Priced<'a>>> {
    columns! {
        "estimator" = |of| &of.row.estimator;
        "sampling" = |of| of.row.sampling.map_or_else(|| Cell::from(&of.row.sampling_kind), Cell::from);
        "control" = |of| &of.row.control;
        "channel" = |of| &of.row.channel;
        "swept" = |of| of.row.swept;
        "draws" = |of| of.point.draws;
        "lookups" = |of| of.point.lookups;
        "seconds" = |of| of.seconds;
        "plain_seconds" = |of| of.plain_seconds;
        "error" = |of| of.point.error;
        "relative_error" = |of| of.point.relative;
        "relative_error_least" = |of| of.point.least;
        "relative_error_most" = |of| of.point.most;
        "predicted_relative_error" = |of| of.point.predicted;
    }
}

/// One line per row of the case and point of its curve.
pub(super) fn artifact(case: &BenchCase) -> Result<Artifact, ReportError> {
    let timed = case.rows.iter().filter_map(|row| Some((row, row.times.as_ref()?)));
    let points = timed.flat_map(|(row, times)| {
        let priced = row.curve.iter().zip(&times.seconds).zip(&times.plain_seconds);
        priced.map(move |((&point, &seconds), &plain_seconds)| Priced {
            row,
            point,
            seconds,
            plain_seconds,
        })
    });
    columns::artifact(&format!("{}.error.csv", case.name), &columns(), points)
}

//! Tables of a bench: `CASE.error.csv`, the measured error against its price, and the rows, as CSV and JSON:
//! `bench.csv` and `--format csv|json` share these columns.
//!
//! Columns that `summary.csv` also has have the same names. `plain` is the plain scalar loop over the same draws;
//! `_least` and `_most` are the minimum and the maximum of the rounds.

use crate::bench::record::{Bench, BenchCase, BenchRow, CurvePoint, Spread, Times};
use crate::report::columns::{self, Cell, Column, columns};
use crate::report::{Artifact, ReportError};

/// Row with its case and bench.
#[derive(Debug, Clone, Copy)]
struct Joined<'a> {
    bench: &'a Bench,
    case: &'a BenchCase,
    row: &'a BenchRow,
}

impl Joined<'_> {
    /// Returns a figure of the times.
    fn timed(&self, figure: impl Fn(&Times) -> Option<f64>) -> Option<f64> {
        self.row.times.as_ref().and_then(figure)
    }

    fn spread(
        &self,
        of: impl Fn(&Times) -> Option<Spread>,
        figure: fn(Spread) -> f64,
    ) -> Option<f64> {
        self.timed(|times| of(times).map(figure))
    }
}

/// Returns the columns, in the order of the files.
fn columns<'a>() -> Vec<Column<Joined<'a>>> {
    columns! {
        "case" = |joined| &joined.case.name;
        "problem" = |joined| &joined.case.problem;
        "medium" = |joined| &joined.case.medium;
        "estimator" = |joined| joined.row.id.label();
        "sampling" = |joined| joined.row.sampling();
        "control" = |joined| &joined.row.id.control;
        "channel" = |joined| &joined.row.channel;
        "swept" = |joined| joined.row.id.swept_value();
        "sampling_kind" = |joined| &joined.row.id.sampling.kind;
        "seed" = |joined| Some(joined.bench.seed);
        "rounds" = |joined| u64::from(joined.bench.rounds);
        "draws" = |joined| joined.row.draws;
        "mean" = |joined| joined.row.mean;
        "truth" = |joined| joined.row.truth;
        "variance" = |joined| joined.row.variance;
        "predicted_variance" = |joined| joined.row.predicted_variance;
        "lookups_per_draw" = |joined| joined.row.lookups_per_draw;
        "predicted_lookups" = |joined| joined.row.predicted_lookups;
        "fom" = |joined| joined.row.fom;
        "threads" = |joined| joined.bench.conditions.threads;
        "clock" = |joined| joined.bench.conditions.clock.word();
        "ns_per_draw" = |joined| joined.spread(|times| Some(times.ns_per_draw), |s| s.median);
        "ns_per_draw_least" = |joined| joined.spread(|times| Some(times.ns_per_draw), |s| s.least);
        "ns_per_draw_most" = |joined| joined.spread(|times| Some(times.ns_per_draw), |s| s.most);
        "draws_per_second" = |joined| joined.timed(|times| Some(times.draws_per_second));
        "ns_per_lookup" = |joined| joined.timed(|times| times.ns_per_lookup);
        "plain_ns_per_draw" = |joined| joined.spread(|times| Some(times.plain_ns_per_draw), |s| s.median);
        "plain_ns_per_draw_least" = |joined| joined.spread(|times| Some(times.plain_ns_per_draw), |s| s.least);
        "plain_ns_per_draw_most" = |joined| joined.spread(|times| Some(times.plain_ns_per_draw), |s| s.most);
        "speedup" = |joined| joined.spread(|times| Some(times.speedup), |s| s.median);
        "speedup_least" = |joined| joined.spread(|times| Some(times.speedup), |s| s.least);
        "speedup_most" = |joined| joined.spread(|times| Some(times.speedup), |s| s.most);
        "scaling" = |joined| joined.spread(|times| times.scaling, |s| s.median);
        "scaling_least" = |joined| joined.spread(|times| times.scaling, |s| s.least);
        "scaling_most" = |joined| joined.spread(|times| times.scaling, |s| s.most);
        "seconds_to_1e-2" = |joined| joined.timed(|times| Some(times.seconds_to?[0]));
        "seconds_to_1e-3" = |joined| joined.timed(|times| Some(times.seconds_to?[1]));
        "seconds_to_1e-4" = |joined| joined.timed(|times| Some(times.seconds_to?[2]));
        "efficiency" = |joined| joined.timed(|times| times.efficiency);
        "reason" = |joined| &joined.row.reason;
        "ttuv" = |joined| joined.timed(Times::ttuv);
        "setup_lookups" = |joined| joined.row.setup_lookups;
        "needs" = |joined| &joined.row.needs;
    }
}

fn joined(bench: &Bench) -> impl Iterator<Item = Joined<'_>> {
    let cases = bench.cases.iter();
    cases.flat_map(move |case| case.rows.iter().map(move |row| Joined { bench, case, row }))
}

/// Returns the rows as CSV, with a first line of names.
///
/// # Errors
///
/// The encoder fails.
pub fn csv(bench: &Bench) -> Result<String, ReportError> {
    columns::csv("the bench", &columns(), joined(bench))
}

/// Returns the rows as a JSON array of objects, one per line; unknown is `null`.
///
/// # Errors
///
/// The encoder fails.
pub fn json(bench: &Bench) -> Result<String, ReportError> {
    columns::json(&columns(), joined(bench))
}

/// Point of a curve with its price.
struct Priced<'a> {
    row: &'a BenchRow,
    times: &'a Times,
    point: &'a CurvePoint,
}

/// Returns the columns of `CASE.error.csv`.
fn error_columns<'a>() -> Vec<Column<Priced<'a>>> {
    columns! {
        "estimator" = |of| of.row.id.label();
        "sampling" = |of| of.row.sampling().map_or_else(|| Cell::from(&of.row.id.sampling.kind), Cell::from);
        "control" = |of| &of.row.id.control;
        "channel" = |of| &of.row.channel;
        "swept" = |of| of.row.id.swept_value();
        "draws" = |of| of.point.draws;
        "lookups" = |of| of.point.lookups;
        "seconds" = |of| of.times.seconds(of.point.draws);
        "plain_seconds" = |of| of.times.plain_seconds(of.point.draws);
        "error" = |of| of.point.error;
        "relative_error" = |of| of.point.relative;
        "relative_error_least" = |of| of.point.least;
        "relative_error_most" = |of| of.point.most;
        "predicted_relative_error" = |of| of.point.predicted;
    }
}

/// Returns the table with one line per row of the case and point of its curve.
pub(super) fn errors(case: &BenchCase) -> Result<Artifact, ReportError> {
    let timed = case.rows.iter().filter_map(|row| Some((row, row.times.as_ref()?)));
    let points = timed
        .flat_map(|(row, times)| row.curve.iter().map(move |point| Priced { row, times, point }));
    columns::artifact(&format!("{}.error.csv", case.name), &error_columns(), points)
}

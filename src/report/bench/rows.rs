//! The rows of a bench, as CSV and JSON: `bench.csv` and `--format csv|json` share these columns.
//!
//! Columns that `summary.csv` has, too, have the same names. `plain` is the plain scalar loop over
//! the same draws; `_least` and `_most` are those of the rounds.

use serde::ser::{Serialize, Serializer};

use crate::bench::record::{Bench, BenchCase, BenchRow, Times};
use crate::bench::spread::Spread;
use crate::report::ReportError;
use crate::report::rows::{Cell, table};

use Cell::{Count, Number, Text};

/// A row with what it belongs to.
#[derive(Debug, Clone, Copy)]
struct Joined<'a> {
    bench: &'a Bench,
    case: &'a BenchCase,
    row: &'a BenchRow,
}

impl Joined<'_> {
    /// A figure of the times.
    fn timed(&self, figure: impl Fn(&Times) -> Option<f64>) -> Cell {
        Number(self.row.times.as_ref().and_then(figure))
    }

    fn spread(&self, of: impl Fn(&Times) -> Option<Spread>, figure: fn(Spread) -> f64) -> Cell {
        self.timed(|times| of(times).map(figure))
    }
}

/// A column: its name and what stands in it.
type Column = (&'static str, fn(&Joined) -> Cell);

macro_rules! columns {
    ($($name:literal = |$joined:ident| $cell:expr;)*) => {
        &[$(($name, |$joined| $cell)),*]
    };
}

const COLUMNS: &[Column] = columns! {
    "case" = |joined| Text(joined.case.name.clone());
    "problem" = |joined| Text(joined.case.problem.clone());
    "medium" = |joined| Text(joined.case.medium.clone());
    "estimator" = |joined| Text(joined.row.estimator.clone());
    "sampling" = |joined| Number(joined.row.sampling);
    "control" = |joined| Text(joined.row.control.clone());
    "channel" = |joined| Text(joined.row.channel.clone());
    "swept" = |joined| Number(joined.row.swept);
    "sampling_kind" = |joined| Text(joined.row.sampling_kind.clone());
    "seed" = |joined| Count(Some(joined.bench.seed));
    "rounds" = |joined| Count(Some(joined.bench.rounds.into()));
    "draws" = |joined| Count(joined.row.draws);
    "mean" = |joined| Number(joined.row.mean);
    "truth" = |joined| Number(joined.row.truth);
    "variance" = |joined| Number(joined.row.variance);
    "predicted_variance" = |joined| Number(joined.row.predicted_variance);
    "lookups_per_draw" = |joined| Number(joined.row.lookups_per_draw);
    "predicted_lookups" = |joined| Number(joined.row.predicted_lookups);
    "fom" = |joined| Number(joined.row.fom);
    "threads" = |joined| Count(Some(joined.bench.conditions.threads as u64));
    "clock" = |joined| Text(joined.bench.conditions.clock.word().to_owned());
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
    "reason" = |joined| Text(joined.row.reason.clone());
};

fn joined(bench: &Bench) -> impl Iterator<Item = Joined<'_>> {
    let rows = |case: &'_ BenchCase| case.rows.len();
    bench.cases.iter().flat_map(move |case| {
        (0..rows(case)).map(move |at| Joined { bench, case, row: &case.rows[at] })
    })
}

/// The rows as CSV, with a first line of names.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn csv(bench: &Bench) -> Result<String, ReportError> {
    let header = COLUMNS.iter().map(|column| column.0);
    let lines = joined(bench)
        .map(|joined| COLUMNS.iter().map(|column| column.1(&joined).csv()).collect::<Vec<_>>());
    table("the bench", header, lines)
}

/// The rows as a JSON array of objects, one to a line; unknown is `null`.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn json(bench: &Bench) -> Result<String, ReportError> {
    let objects: Result<Vec<_>, _> =
        joined(bench).map(|joined| serde_json::to_string(&Object(joined))).collect();
    let objects = objects?.join(",\n");
    Ok(if objects.is_empty() { "[]\n".to_owned() } else { format!("[\n{objects}\n]\n") })
}

struct Object<'a>(Joined<'a>);

impl Serialize for Object<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(COLUMNS.iter().map(|column| (column.0, column.1(&self.0))))
    }
}

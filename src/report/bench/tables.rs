//! Tables of a bench: `CASE.error.csv`, the measured error against its price, and the rows, as CSV and JSON:
//! `bench.csv` and `--format csv|json` share these columns.
//!
//! Columns that `summary.csv` also has have the same names. `plain` is the plain scalar loop over the same draws;
//! `_least` and `_most` are the minimum and the maximum of the rounds.

use crate::bench::record::{Bench, BenchCase, BenchRow, CurvePoint, Spread, Times};
use crate::report::fields::{self, Cell, Table, table};
use crate::report::{Artifact, ReportError};
use numeric::digits::fixed;

/// Row with its case and bench.
#[derive(Debug, Clone, Copy)]
pub struct BenchEntry<'a> {
    /// Bench.
    pub bench: &'a Bench,
    /// Case.
    pub case: &'a BenchCase,
    /// Row.
    pub row: &'a BenchRow,
}

impl BenchEntry<'_> {
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

    /// Returns the minimum and the maximum of the rounds.
    fn range(&self, of: fn(&Times) -> Option<Spread>) -> String {
        let spread = self.row.times.as_ref().and_then(of);
        spread
            .map_or_else(String::new, |of| format!("{}–{}", fixed(of.least, 3), fixed(of.most, 3)))
    }

    /// Returns a sampling extinction or a swept value in the digits of its case.
    fn digits(&self, value: Option<f64>) -> Option<String> {
        value.map(|value| self.case.digits().text(value))
    }
}

table! {
    impl<'a> for BenchEntry<'a> {
        "case" = |joined| &joined.case.name;
        "problem" = |joined| &joined.case.problem;
        "medium" = |joined| &joined.case.medium;
        "estimator" = |joined| joined.row.id.label();
        "sampling" ["σ̂", "1/length", Short(4)] = |joined| joined.row.sampling();
        "control" = |joined| &joined.row.id.control;
        "channel" = |joined| &joined.row.channel;
        "swept" ["swept", "", Short(4)] = |joined| joined.row.id.swept_value();
        "sampling_kind" ["kind of σ̂", "", Plain] = |joined| &joined.row.id.sampling.kind;
        "seed" = |joined| Some(joined.bench.seed);
        "rounds": "Number of rounds; times are medians of them" = |joined| u64::from(joined.bench.rounds);
        "draws": "Number of draws of a round" = |joined| joined.row.draws;
        "mean" = |joined| joined.row.mean;
        "truth" = |joined| joined.row.truth;
        "variance" = |joined| joined.row.variance;
        "predicted_variance" = |joined| joined.row.predicted_variance;
        "lookups_per_draw" = |joined| joined.row.lookups_per_draw;
        "predicted_lookups" = |joined| joined.row.predicted_lookups;
        "fom" ["1/VN", "", Fixed(3)]: "Figure of merit 1/(variance × lookups)" = |joined| joined.row.fom;
        "threads": "Number of threads" = |joined| joined.bench.conditions.threads;
        "clock": "Clock of the times: processor or wall" = |joined| joined.bench.conditions.clock.word();
        "ns_per_draw" ["ns/draw", "ns", Fixed(3)]: "Time of a draw in nanoseconds, the median of the rounds" = |joined| joined.spread(|times| Some(times.ns_per_draw), |s| s.median);
        "ns_per_draw_least" ["least", "ns", Fixed(3)]: "Its minimum" = |joined| joined.spread(|times| Some(times.ns_per_draw), |s| s.least);
        "ns_per_draw_most" ["most", "ns", Fixed(3)]: "Its maximum" = |joined| joined.spread(|times| Some(times.ns_per_draw), |s| s.most);
        "draws_per_second" ["draws/s", "1/s", Fixed(3)]: "Draws of a second on one thread" = |joined| joined.timed(|times| Some(times.draws_per_second));
        "ns_per_lookup" ["ns/lookup", "ns", Fixed(3)]: "Time of a lookup in nanoseconds" = |joined| joined.timed(|times| times.ns_per_lookup);
        "plain_ns_per_draw": "Time of a draw of the plain scalar loop over the same draws" = |joined| joined.spread(|times| Some(times.plain_ns_per_draw), |s| s.median);
        "plain_ns_per_draw_least": "Its minimum" = |joined| joined.spread(|times| Some(times.plain_ns_per_draw), |s| s.least);
        "plain_ns_per_draw_most": "Its maximum" = |joined| joined.spread(|times| Some(times.plain_ns_per_draw), |s| s.most);
        "speedup" ["speedup", "", Fixed(3)]: "Time of the plain loop over that of the estimator" = |joined| joined.spread(|times| Some(times.speedup), |s| s.median);
        "speedup_least": "Its minimum" = |joined| joined.spread(|times| Some(times.speedup), |s| s.least);
        "speedup_most": "Its maximum" = |joined| joined.spread(|times| Some(times.speedup), |s| s.most);
        "scaling" ["scaling", "", Fixed(3)]: "Speed on all threads over that on one" = |joined| joined.spread(|times| times.scaling, |s| s.median);
        "scaling_least": "Its minimum" = |joined| joined.spread(|times| times.scaling, |s| s.least);
        "scaling_most": "Its maximum" = |joined| joined.spread(|times| times.scaling, |s| s.most);
        "seconds_to_1e-2" ["to 1e-2", "s", Time]: "Seconds to a relative error of 1e-2" = |joined| joined.timed(|times| Some(times.seconds_to?[0]));
        "seconds_to_1e-3" ["to 1e-3", "s", Time]: "Seconds to a relative error of 1e-3" = |joined| joined.timed(|times| Some(times.seconds_to?[1]));
        "seconds_to_1e-4" ["to 1e-4", "s", Time]: "Seconds to a relative error of 1e-4" = |joined| joined.timed(|times| Some(times.seconds_to?[2]));
        "efficiency" ["1/Vt", "", Fixed(3)]: "1/(variance × time)" = |joined| joined.timed(|times| times.efficiency);
        "reason" ["note", "", Plain]: "Reason why it was not timed" = |joined| &joined.row.reason;
        "ttuv" ["Vt", "s", Time]: "Time to unit variance: variance × time" = |joined| joined.timed(Times::ttuv);
        "setup_lookups" = |joined| joined.row.setup_lookups;
        "needs" = |joined| &joined.row.needs;
    } screens {
        "sampling_marked" ["σ̂", "1/length", Right]: "σ̂, or its kind; a constant with the digits that distinguish it in its case"
            = |joined| joined.digits(joined.row.sampling()).unwrap_or_else(|| joined.row.id.sampling.kind.clone());
        "ns_per_draw_range" ["least–most", "ns", Right]: "Minimum and maximum of the time of a draw" = |joined| joined.range(|times| Some(times.ns_per_draw));
        "speedup_range" ["least–most", "", Right]: "Minimum and maximum of the speedup" = |joined| joined.range(|times| Some(times.speedup));
    }
}

pub(super) fn joined(bench: &Bench) -> impl Iterator<Item = BenchEntry<'_>> {
    let cases = bench.cases.iter();
    cases.flat_map(move |case| case.rows.iter().map(move |row| BenchEntry { bench, case, row }))
}

/// Returns the rows as CSV, with a first line of names.
pub fn csv(bench: &Bench) -> Result<String, ReportError> {
    fields::csv("the bench", &BenchEntry::of_files(), joined(bench))
}

/// Returns the rows as a JSON array of objects, one per line; unknown is `null`.
pub fn json(bench: &Bench) -> Result<String, ReportError> {
    fields::json(&BenchEntry::of_files(), joined(bench))
}

/// Point of a curve with its price.
pub struct Priced<'a> {
    row: &'a BenchRow,
    times: &'a Times,
    point: &'a CurvePoint,
}

table! {
    impl<'a> for Priced<'a> {
        "estimator" = |of| of.row.id.label();
        "sampling": "Sampling extinction σ̂, if it is a constant" = |of| of.row.sampling().map_or_else(|| Cell::from(&of.row.id.sampling.kind), Cell::from);
        "control" = |of| &of.row.id.control;
        "channel" = |of| &of.row.channel;
        "swept" = |of| of.row.id.swept_value();
        "draws": "Number of draws of a round" = |of| of.point.draws;
        "lookups": "Number of lookups of the draws" = |of| of.point.lookups;
        "seconds": "Time of the draws" = |of| of.times.seconds(of.point.draws);
        "plain_seconds": "Time of the plain loop over them" = |of| of.times.plain_seconds(of.point.draws);
        "error": "Measured error of the mean" = |of| of.point.error;
        "relative_error": "Its size relative to the truth" = |of| of.point.relative;
        "relative_error_least": "Smallest relative error of the repetitions" = |of| of.point.least;
        "relative_error_most": "Largest relative error of the repetitions" = |of| of.point.most;
        "predicted_relative_error": "Relative error in theory" = |of| of.point.predicted;
    }
}

/// Returns the table with one line per row of the case and point of its curve.
pub(super) fn errors(case: &BenchCase) -> Result<Artifact, ReportError> {
    let timed = case.rows.iter().filter_map(|row| Some((row, row.times.as_ref()?)));
    let points = timed
        .flat_map(|(row, times)| row.curve.iter().map(move |point| Priced { row, times, point }));
    fields::artifact(&format!("{}.error.csv", case.name), &Priced::fields(), points)
}

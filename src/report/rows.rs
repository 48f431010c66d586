//! The rows of a record joined with their case and their timing, as CSV and JSON.
//!
//! `summary.csv`, the files of the cases and `--format csv|json` share these columns, so that a
//! number has one name everywhere.

use crate::record::{CaseRecord, Record, Row, Verdict};
use crate::report::ReportError;
use crate::report::columns::{self, Column, columns};

/// A row of the record with what it belongs to.
#[derive(Debug, Clone, Copy)]
pub struct JoinedRow<'a> {
    /// The case.
    pub case: &'a CaseRecord,
    /// The row.
    pub row: &'a Row,
    /// Whether it is the first of its experiment.
    pub is_first: bool,
    /// The run's seed.
    pub seed: u64,
    /// Processor seconds of the experiment's drawing.
    pub seconds: Option<f64>,
    /// Whether an earlier run drew it.
    pub is_reused: bool,
}

impl JoinedRow<'_> {
    /// Why the row has its verdict; where nothing is to be said of that, what is doubtful about its case.
    pub fn reason(&self) -> String {
        let reason = &self.row.reason;
        if reason.is_empty() { self.case.notes.join("; ") } else { reason.clone() }
    }

    /// Nanoseconds of processor time for one lookup of `σ_t`; `None` where nothing was looked up.
    pub fn ns_per_lookup(&self) -> Option<f64> {
        let lookups = self.row.drawn? as f64 * self.row.lookups_per_draw?;
        (lookups > 0.0).then_some(self.seconds? * 1e9 / lookups)
    }
}

/// Every row of the record, joined.
pub fn joined(record: &Record) -> Vec<JoinedRow<'_>> {
    let seed = record.results.seed;
    let mut rows = Vec::new();
    for (c, case) in record.results.cases.iter().enumerate() {
        for (r, row) in case.rows.iter().enumerate() {
            let seconds = record.timing.rows.get(c).and_then(|rows| *rows.get(r)?);
            let reused = record.timing.reused.get(c).and_then(|rows| rows.get(r));
            let is_reused = reused.copied().unwrap_or_default();
            let is_first = case.begins_experiment(r);
            rows.push(JoinedRow { case, row, is_first, seed, seconds, is_reused });
        }
    }
    rows
}

/// The columns that differ from run to run, so that results proper leave them out.
pub const TIMED: [&str; 3] = ["seconds", "ns_per_lookup", "reused"];

/// The columns, in the order in which files have them.
pub fn columns<'a>() -> Vec<Column<JoinedRow<'a>>> {
    columns! {
        "case" = |joined| &joined.case.name;
        "problem" = |joined| &joined.case.problem;
        "medium" = |joined| &joined.case.medium;
        "estimator" = |joined| &joined.row.estimator;
        "sampling" = |joined| joined.row.sampling;
        "control" = |joined| &joined.row.control;
        "channel" = |joined| &joined.row.channel;
        "seed" = |joined| joined.seed;
        "draws" = |joined| joined.row.draws;
        "mean" = |joined| joined.row.mean;
        "standard_error" = |joined| joined.row.standard_error;
        "truth" = |joined| joined.row.truth;
        "truth_error" = |joined| joined.row.truth_error;
        "z_mean" = |joined| joined.row.z_mean;
        "variance" = |joined| joined.row.variance;
        "predicted_variance" = |joined| joined.row.predicted_variance;
        "z_variance" = |joined| joined.row.z_variance;
        "lookups_per_draw" = |joined| joined.row.lookups_per_draw;
        "predicted_lookups" = |joined| joined.row.predicted_lookups;
        "z_lookups" = |joined| joined.row.z_lookups;
        "predicted_kurtosis" = |joined| joined.row.predicted_kurtosis;
        "detectable_bias" = |joined| joined.row.detectable_bias;
        "fom" = |joined| joined.row.fom;
        "seconds" = |joined| joined.seconds;
        "ns_per_lookup" = |joined| joined.ns_per_lookup();
        "verdict" = |joined| joined.row.verdict.map(Verdict::word);
        "reason" = |joined| joined.reason();
        "sampling_kind" = |joined| &joined.row.sampling_kind;
        "swept" = |joined| joined.row.swept;
        "predicted_skewness" = |joined| joined.row.predicted_skewness;
        "predicted_fom" = |joined| joined.row.predicted_fom;
        "stable_share" = |joined| joined.row.stable_share;
        "best_sampling" = |joined| joined.row.best_sampling;
        "best_fom" = |joined| joined.row.best_fom;
        "p_law" = |joined| joined.row.p_law;
        "drawn" = |joined| joined.row.drawn;
        "kernel" = |joined| &joined.row.kernel;
        "same_as" = |joined| &joined.row.same_as;
        "sharing" = |joined| joined.row.sharing;
        "skipped" = |joined| joined.row.skipped;
        "loss_1" = |joined| joined.row.losses.map(|losses| losses[0]);
        "loss_2" = |joined| joined.row.losses.map(|losses| losses[1]);
        "loss_3" = |joined| joined.row.losses.map(|losses| losses[2]);
        "loss_4" = |joined| joined.row.losses.map(|losses| losses[3]);
        "relative_m2" = |joined| joined.row.relative_moments[0];
        "relative_m3" = |joined| joined.row.relative_moments[1];
        "relative_m4" = |joined| joined.row.relative_moments[2];
        "lookups_variance" = |joined| joined.row.lookups_variance;
        "rare_event_size" = |joined| joined.row.rare_event_size;
        "log_unit" = |joined| joined.row.log_unit;
        "reused" = |joined| joined.is_reused.then_some("yes");
        "moments_error" = |joined| joined.row.moments_error;
        "not_normal" = |joined| joined.row.not_normal.join(" ");
        "log10_ltuv" = |joined| joined.row.log10_ltuv();
        "predicted_log10_ltuv" = |joined| joined.row.predicted_log10_ltuv();
        "setup_lookups" = |joined| joined.row.setup_lookups;
        "draws_per_ray" = |joined| joined.case.draws_per_ray;
        "needs" = |joined| &joined.row.needs;
        "best_kind" = |joined| &joined.row.best_kind;
        "best_limit" = |joined| joined.row.best_limit;
    }
}

/// The rows of a record as CSV, with a first line of names.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn csv(record: &Record) -> Result<String, ReportError> {
    columns::csv("the rows", &columns(), joined(record))
}

/// The rows of a record as a JSON array of objects, one to a line. The names are the columns of
/// the CSV, and `lookups_pmf`, an array that is empty where it is unknown or long.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn json(record: &Record) -> Result<String, ReportError> {
    let lists: Vec<Column<JoinedRow>> = columns! {
        "lookups_pmf" = |joined| &joined.row.lookups_pmf;
    };
    let all: Vec<_> = columns().into_iter().chain(lists).collect();
    columns::json(&all, joined(record))
}

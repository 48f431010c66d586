//! `summary.csv`: every experiment and channel of the run on one line, results and timing joined.
//!
//! `summary.csv`, the files of the cases and `--format csv|json` share these columns, so that a number has the same
//! name everywhere.

use std::ops::Deref;

use crate::record::{Record, Row, Verdict};
use crate::report::columns::{self, Column, columns};
use crate::report::{Artifact, ReportError};

/// Row of a record with the seed of the run; it dereferences to the row.
#[derive(Debug, Clone, Copy)]
pub struct Line<'a> {
    /// Row.
    pub row: Row<'a>,
    /// Seed of the run.
    pub seed: u64,
}

impl<'a> Deref for Line<'a> {
    type Target = Row<'a>;

    fn deref(&self) -> &Row<'a> {
        &self.row
    }
}

/// Returns all rows of a record.
pub fn lines(record: &Record) -> impl Iterator<Item = Line<'_>> {
    let seed = record.results.seed;
    record.results.rows().map(move |row| Line { row, seed })
}

/// Columns that differ from run to run, which files of results alone leave out.
pub const TIMED: [&str; 3] = ["seconds", "ns_per_lookup", "reused"];

/// Returns the columns, in the order of the files.
pub fn columns<'a>() -> Vec<Column<Line<'a>>> {
    columns! {
        "case" = |line| &line.case.name;
        "problem" = |line| &line.case.problem;
        "medium" = |line| &line.case.medium;
        "estimator" = |line| &line.experiment.label;
        "sampling" = |line| line.experiment.sampling();
        "control" = |line| &line.experiment.id.control;
        "channel" = |line| &line.channel;
        "seed" = |line| line.seed;
        "draws" = |line| line.experiment.draws;
        "mean" = |line| line.mean;
        "standard_error" = |line| line.standard_error;
        "truth" = |line| line.truth;
        "truth_error" = |line| line.truth_error;
        "z_mean" = |line| line.z_mean;
        "variance" = |line| line.variance;
        "predicted_variance" = |line| line.predicted_variance;
        "z_variance" = |line| line.z_variance;
        "lookups_per_draw" = |line| line.experiment.lookups_per_draw;
        "predicted_lookups" = |line| line.experiment.predicted_lookups;
        "z_lookups" = |line| line.experiment.z_lookups;
        "predicted_kurtosis" = |line| line.predicted_kurtosis;
        "detectable_bias" = |line| line.detectable_bias;
        "fom" = |line| line.fom;
        "seconds" = |line| line.experiment.spent.seconds;
        "ns_per_lookup" = |line| line.ns_per_lookup();
        "verdict" = |line| line.verdict.map(Verdict::word);
        "reason" = |line| line.why();
        "sampling_kind" = |line| &line.experiment.id.sampling.kind;
        "swept" = |line| line.experiment.swept();
        "predicted_skewness" = |line| line.predicted_skewness;
        "predicted_fom" = |line| line.predicted_fom;
        "stable_share" = |line| line.experiment.stable_share;
        "best_sampling" = |line| line.best_sampling();
        "best_fom" = |line| line.best_fom();
        "p_law" = |line| line.experiment.p_law;
        "drawn" = |line| line.experiment.drawn;
        "same_as" = |line| line.experiment.same_as();
        "skipped" = |line| line.experiment.skipped;
        "loss_1" = |line| line.losses.map(|losses| losses[0]);
        "loss_2" = |line| line.losses.map(|losses| losses[1]);
        "loss_3" = |line| line.losses.map(|losses| losses[2]);
        "loss_4" = |line| line.losses.map(|losses| losses[3]);
        "relative_m2" = |line| line.relative_moments[0];
        "relative_m3" = |line| line.relative_moments[1];
        "relative_m4" = |line| line.relative_moments[2];
        "lookups_variance" = |line| line.experiment.lookups_variance;
        "rare_event_size" = |line| line.rare_event_size;
        "log_unit" = |line| line.log_unit;
        "reused" = |line| line.experiment.spent.is_reused.then_some("yes");
        "moments_error" = |line| line.moments_error;
        "not_normal" = |line| line.not_normal.iter().map(|score| score.word()).collect::<Vec<_>>().join(" ");
        "log10_ltuv" = |line| line.log10_ltuv();
        "predicted_log10_ltuv" = |line| line.predicted_log10_ltuv();
        "setup_lookups" = |line| line.experiment.setup_lookups;
        "draws_per_ray" = |line| line.case.draws_per_ray;
        "needs" = |line| &line.experiment.needs;
        "best_kind" = |line| line.best_kind();
        "best_limit" = |line| line.best_limit();
        "lookups_error" = |line| line.experiment.lookups_error;
        "covariance" = |line| line.covariance;
    }
}

/// Returns the rows of a record as CSV, with a first line of names.
///
/// # Errors
///
/// The encoder fails.
pub fn csv(record: &Record) -> Result<String, ReportError> {
    columns::csv("the rows", &columns(), lines(record))
}

/// Returns the rows of a record as a JSON array of objects, one per line. The names are the columns of the CSV, and
/// `lookups_pmf`, an array that is empty if it is unknown or long.
///
/// # Errors
///
/// The encoder fails.
pub fn json(record: &Record) -> Result<String, ReportError> {
    let lists: Vec<Column<Line>> = columns! {
        "lookups_pmf" = |line| &line.experiment.lookups_pmf;
    };
    let all: Vec<_> = columns().into_iter().chain(lists).collect();
    columns::json(&all, lines(record))
}

/// Returns the file with one row for each experiment and channel.
///
/// # Errors
///
/// The encoder fails.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![Artifact::text("summary.csv", csv(record)?)])
}

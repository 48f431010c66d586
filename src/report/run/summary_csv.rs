//! `summary.csv`: every experiment and channel of the run on one line, results and timing joined.
//!
//! `summary.csv`, the files of the cases and `--format csv|json` share these columns, so that a number has the same
//! name everywhere.

use std::ops::Deref;

use crate::record::{Record, Row};
use crate::report::fields::{self, Field, Table, fields};
use crate::report::{Artifact, ReportError};

/// Row of a record with the seed of the run; it dereferences to the row.
#[derive(Debug, Clone, Copy)]
pub struct SummaryRow<'a> {
    /// Row.
    pub row: Row<'a>,
    /// Seed of the run.
    pub seed: u64,
}

impl<'a> Deref for SummaryRow<'a> {
    type Target = Row<'a>;

    fn deref(&self) -> &Row<'a> {
        &self.row
    }
}

/// Returns all rows of a record.
pub fn lines(record: &Record) -> impl Iterator<Item = SummaryRow<'_>> {
    let seed = record.results.seed;
    record.results.rows().map(move |row| SummaryRow { row, seed })
}

/// Returns the rows of a record as CSV, with a first line of names.
pub fn csv(record: &Record) -> Result<String, ReportError> {
    fields::csv("the rows", &SummaryRow::of_files(), lines(record))
}

/// Returns the rows of a record as a JSON array of objects, one per line. The names are the columns of the CSV, and
/// `lookups_pmf`, an array that is empty if it is unknown or long.
pub fn json(record: &Record) -> Result<String, ReportError> {
    fields::json(&with_lists(), lines(record))
}

/// Returns the rows of a record as a JSON object of columns, with the names of [`json`].
pub fn columns(record: &Record) -> Result<String, ReportError> {
    fields::columns(&with_lists(), &lines(record).collect::<Vec<_>>())
}

fn with_lists<'a>() -> Vec<Field<SummaryRow<'a>>> {
    let lists: Vec<Field<SummaryRow>> = fields! {
        "lookups_pmf": "Probabilities of 0, 1, … lookups" = |line| &line.experiment.lookups_pmf;
    };
    SummaryRow::of_files().into_iter().chain(lists).collect()
}

/// Returns the file with one row for each experiment and channel.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    Ok(vec![Artifact::text("summary.csv", csv(record)?)])
}

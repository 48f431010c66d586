//! Reports of the lab, and the columns of their tables.

#![allow(clippy::missing_errors_doc)] // `ReportError` tells all of them

pub mod self_test;
pub mod stress;

use crate::mutants::Caught;
use crate::self_test::calibration::Rate;
use crate::self_test::streams::StreamVerdicts;
use crate::stress::TrialRow;
use trueflight::report::manual::{self, of_files};

/// Returns the page of the manual about all columns, those of the lab's tables last.
pub fn columns() -> String {
    manual::columns(&[
        ("Promised rates: `self-test/calibration.csv`", of_files::<&Rate>()),
        ("Foreign streams: `self-test/foreign-streams.csv`", of_files::<&StreamVerdicts>()),
        ("Known bugs: `self-test/mutants.csv`", of_files::<&Caught>()),
        ("Bounds: `stress/stress.csv`", of_files::<&TrialRow>()),
        ("Single precision: `stress/single-precision.csv`", of_files::<stress::PrecisionPoint>()),
    ])
}

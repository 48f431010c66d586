//! The gate tested on the experiments of cases: does it keep its promises on correct estimators, and does it catch known
//! bugs?
//!
//! [`calibration`] runs correct experiments many times; [`mutation`] draws every known bug in the place of its correct
//! estimator and asks whether the check that must catch it does. What is counted, the bugs, and correct foreign draws of
//! hard laws are in [`lab`], which needs no cases.

pub mod calibration;
pub mod mutation;

use lab::calibration::Calibration;
use lab::mutants::Caught;
use lab::streams::StreamVerdicts;

/// Results of a self-test.
#[derive(Debug, Clone)]
pub struct SelfTest {
    /// The promises.
    pub calibration: Calibration,
    /// Correct foreign draws.
    pub streams: Vec<StreamVerdicts>,
    /// The bugs.
    pub mutants: Vec<Caught>,
    /// Wall-clock seconds.
    pub seconds: f64,
}

impl SelfTest {
    /// Returns whether every promise is kept and every bug is caught.
    pub fn holds(&self) -> bool {
        self.calibration.holds()
            && self.streams.iter().all(StreamVerdicts::is_kept)
            && self.mutants.iter().all(Caught::is_right)
    }
}

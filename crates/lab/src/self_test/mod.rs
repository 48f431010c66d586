//! Tests of the gate on the experiments of cases: does it keep its promises on correct estimators, and does it detect
//! known bugs?
//!
//! [`calibration`] runs correct experiments many times. [`mutation`] draws every known bug in the place of its correct
//! estimator, and tests whether its check detects it. [`streams`] are correct foreign draws of difficult distributions.

pub mod calibration;
pub mod mutation;
pub mod streams;

use crate::mutants::Caught;
use crate::self_test::calibration::Calibration;
use crate::self_test::streams::StreamVerdicts;

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

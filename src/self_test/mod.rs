//! The gate tested: does it keep its promises on correct estimators, and does it catch known bugs?
//!
//! [`calibration`] runs correct experiments many times and compares the rates of false alarms and
//! false passes with the promise; [`streams`] judges correct foreign draws of hard laws; [`mutation`]
//! draws every known bug in the place of its honest estimator and asks whether the check that must
//! catch it does.

pub mod calibration;
pub mod known_bugs;
pub mod mutation;
pub mod streams;

pub use calibration::Calibration;
pub use mutation::Caught;
pub use streams::StreamVerdicts;

/// What a self-test found.
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
    /// Whether every promise is kept and every bug is caught.
    pub fn holds(&self) -> bool {
        self.calibration.holds()
            && self.streams.iter().all(StreamVerdicts::is_kept)
            && self.mutants.iter().all(Caught::is_right)
    }
}

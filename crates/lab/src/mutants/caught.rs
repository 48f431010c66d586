//! Findings of the gate on a known bug.

/// Result of drawing one mutant in the place of its estimator.
#[derive(Debug, Clone)]
pub struct Caught {
    /// Name of the mutant.
    pub name: &'static str,
    /// The bug in one sentence.
    pub bug: &'static str,
    /// The case.
    pub case: &'static str,
    /// The estimator that the mutant replaces.
    pub estimator: String,
    /// The check that must catch it.
    pub check: &'static str,
    /// The draws that the check took; `None` if it did not catch the bug.
    pub draws: Option<u64>,
    /// All checks that failed.
    pub failed: Vec<String>,
    /// True if the control passed: the code without the bug.
    pub twin_passes: bool,
}

impl Caught {
    /// Returns true if the bug was caught and its control passed.
    pub fn is_right(&self) -> bool {
        self.draws.is_some() && self.twin_passes
    }
}

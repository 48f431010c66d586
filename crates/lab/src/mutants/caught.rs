//! Findings of the gate on a known bug.

/// Result of drawing one mutant in the place of its estimator.
#[derive(Debug, Clone)]
pub struct Caught {
    /// Its name.
    pub name: &'static str,
    /// The bug in one sentence.
    pub bug: &'static str,
    /// The case.
    pub case: &'static str,
    /// The estimator in whose place it is drawn.
    pub estimator: String,
    /// The check that must catch it.
    pub check: &'static str,
    /// The draws that the check took; `None` if it did not catch the bug.
    pub draws: Option<u64>,
    /// Which checks failed, the one that must among them.
    pub failed: Vec<String>,
    /// Whether the honest twin passed.
    pub twin_passes: bool,
}

impl Caught {
    /// Whether the bug was caught and the twin was not.
    pub fn is_right(&self) -> bool {
        self.draws.is_some() && self.twin_passes
    }
}

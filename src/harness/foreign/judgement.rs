//! What is said of another program's draws.

use serde::Serialize;

use crate::harness::record::{GateFinding, Verdict};

/// The verdict on a list of draws, with its numbers.
#[derive(Debug, Clone, Serialize)]
pub struct Judgement {
    /// `pass`, `fail` or `inconclusive`.
    pub verdict: Verdict,
    /// Why, in words; empty for a plain pass.
    pub reason: String,
    /// What the verdict promises, and what it does not.
    pub guarantees: Vec<String>,
    /// α: the chance that correct draws fail.
    pub alpha: f64,
    /// β: the chance that a scalar passes although it is off by its tolerance.
    pub beta: f64,
    /// How many draws were read.
    pub draws: u64,
    /// How many there are, where that is known.
    pub length: Option<u64>,
    /// What the mean should be.
    pub truth: f64,
    /// What the tolerance of the mean is relative to.
    pub unit: f64,
    /// The mean of the draws.
    pub mean: Option<f64>,
    /// Its standard error: from the variance claimed, else from that of the draws.
    pub standard_error: Option<f64>,
    /// (mean − truth) in standard errors.
    pub z: Option<f64>,
    /// The unbiased sample variance.
    pub variance: Option<f64>,
    /// The variance claimed.
    pub predicted_variance: Option<f64>,
    /// s²/V.
    pub variance_ratio: Option<f64>,
    /// The standard deviation of s²/V: from the kurtosis claimed, else from that of the draws.
    pub variance_band: Option<f64>,
    /// The sample kurtosis.
    pub kurtosis: Option<f64>,
    /// The first draw that refutes the claim by itself, counted from 0.
    pub refuted_by: Option<u64>,
    /// What the gate found of the mean and of the variance.
    pub findings: Vec<ScalarFinding>,
}

/// What the gate found of one scalar.
#[derive(Debug, Clone, Serialize)]
pub struct ScalarFinding {
    /// `mean` or `variance`.
    pub check: String,
    /// What is said of it.
    pub verdict: Verdict,
    /// Why.
    pub reason: String,
    /// Whether its variance was estimated from earlier draws.
    pub is_estimated: bool,
    /// Whether correct draws of the planned number pass.
    pub is_promised: bool,
    /// Where the gate stands; `None` where its variance could not be estimated.
    pub gate: Option<GateFinding>,
}

impl Judgement {
    /// What was found of a scalar.
    #[must_use]
    pub fn finding(&self, check: &str) -> Option<&ScalarFinding> {
        self.findings.iter().find(|finding| finding.check == check)
    }
}

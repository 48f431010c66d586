//! What an experiment is called.

/// The words for one experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Names {
    /// The estimator with its settings.
    pub estimator: String,
    /// The constant σ̂, 1/length.
    pub sampling: Option<f64>,
    /// σ̂ in words.
    pub sampling_kind: String,
    /// The control in words.
    pub control: String,
    /// The estimator that it is by definition, where that is another one.
    pub alias: Option<String>,
}

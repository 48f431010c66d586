//! Names of estimators and experiments.

use std::fmt::{self, Display, Formatter};

use serde::{Deserialize, Serialize};

/// Name of an estimator in the catalogue, with its own settings.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct EstimatorName {
    /// Name in the catalogue.
    pub name: String,
    /// Its settings in words, as in `non-terminating, a=0.7`; empty without any.
    pub settings: String,
}

/// The label in tables, as in `single (non-terminating, a=0.7)`.
impl Display for EstimatorName {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        match self.settings.as_str() {
            "" => write!(f, "{}", self.name),
            settings => write!(f, "{} ({settings})", self.name),
        }
    }
}

/// Names of one experiment in tables.
#[derive(Debug, Clone, PartialEq)]
pub struct Names {
    /// The estimator with its settings.
    pub estimator: EstimatorName,
    /// The constant σ̂, 1/length.
    pub sampling: Option<f64>,
    /// σ̂ in words.
    pub sampling_kind: String,
    /// The control in words.
    pub control: String,
    /// The estimator that it is by definition, where that is another one.
    pub alias: Option<EstimatorName>,
}

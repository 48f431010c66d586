//! What a comparison of two benches says.

use serde::Serialize;

use super::spread::Spread;

/// What changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// What the stored bench is called.
    pub name: String,
    /// How much more time is no regression, as a share.
    pub tolerance: f64,
    /// How many experiments were compared.
    pub compared: usize,
    /// What became slower or faster.
    pub changes: Vec<Change>,
    /// Experiments of this bench that the stored one has not.
    pub added: Vec<String>,
    /// Experiments of the stored bench that this one has not.
    pub missing: Vec<String>,
    /// Experiments whose case has another text.
    pub rewritten: Vec<String>,
    /// The vector hardware of both, where it differs.
    pub levels: Option<[String; 2]>,
}

/// A time per draw that changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// The experiment.
    pub id: String,
    /// Nanoseconds of a draw, stored and now.
    pub ns_per_draw: [Spread; 2],
    /// The speedup over the plain loop, stored and now.
    pub speedup: [Spread; 2],
    /// Now over stored, of the medians of the times.
    pub ratio: f64,
    /// Whether it became slower.
    pub is_regression: bool,
}

impl Comparison {
    /// Whether anything became slower.
    pub fn fails(&self) -> bool {
        self.changes.iter().any(|change| change.is_regression)
    }

    /// Whether nothing was compared with anything: such a comparison says nothing.
    pub fn is_empty(&self) -> bool {
        self.compared == 0
    }
}

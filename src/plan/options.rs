//! What a run is asked to do, whatever the cases are.

use crate::plan::filter::Filter;
use estimators::Order;

/// Draws per experiment where neither the options nor the case say.
pub const DRAWS: u64 = 4_000_000;

/// What a run is asked to do.
#[derive(Debug, Clone)]
pub struct Options {
    /// The seed of all random numbers.
    pub seed: u64,
    /// How many draws.
    pub draws: Amount,
    /// The kernel that the cases were told to draw by, whatever they say: part of the command that
    /// repeats an experiment.
    pub kernel: Option<Order>,
    /// The chance that a correct run shows any failure.
    pub alpha: f64,
    /// Stop drawing after this many seconds.
    pub seconds: Option<f64>,
    /// Stop drawing after this many draws of all experiments together.
    pub budget: Option<u64>,
    /// How many blocks of 2¹⁴ draws are drawn, kept and merged as one; the gate looks between them.
    pub blocks_per_look: u64,
    /// Draw exactly what is planned: the gate stops nothing.
    pub fixed: bool,
    /// Whether each check that is underpowered makes its experiment inconclusive.
    pub strict: bool,
    /// Stop an experiment as soon as the check of this name has failed.
    pub until_failed: Option<String>,
    /// Only these experiments.
    pub filter: Option<Filter>,
}

/// How many draws an experiment makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Amount {
    /// So many, whatever the cases say.
    Exactly(u64),
    /// What the case says; without a word of it, so many.
    CaseOr(u64),
}

impl Amount {
    /// How many draws of an experiment whose case says `case`.
    pub(crate) fn of(self, case: Option<u64>) -> u64 {
        match self {
            Self::Exactly(draws) => draws,
            Self::CaseOr(draws) => case.unwrap_or(draws),
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 1,
            draws: Amount::CaseOr(DRAWS),
            kernel: None,
            alpha: 1e-3,
            seconds: None,
            budget: None,
            blocks_per_look: 1,
            fixed: false,
            strict: false,
            until_failed: None,
            filter: None,
        }
    }
}

/// The smallest relative differences that must be seen; `None` where the case does not say.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tolerance {
    /// Of the mean, relative to the truth.
    pub mean: Option<f64>,
    /// Of the variance, relative to the prediction.
    pub variance: Option<f64>,
    /// Of the lookups, relative to the prediction.
    pub lookups: Option<f64>,
}

impl Tolerance {
    /// Whether the case has any.
    pub fn says_something(&self) -> bool {
        *self != Self::default()
    }
}

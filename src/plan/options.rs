//! Options of a run, for all cases.

use crate::case::id::EstimatorName;
use gate::CheckId;
use glob::{Pattern, PatternError};

/// Number of draws per experiment if neither the options nor the case give it.
pub const DRAWS: u64 = 4_000_000;

/// Options of a run.
#[derive(Debug, Clone)]
pub struct Options {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Number of draws of an experiment.
    pub draws: Amount,
    /// Probability that a correct run shows any failure.
    pub alpha: f64,
    /// Stop drawing after this many seconds.
    pub seconds: Option<f64>,
    /// Stop drawing after this many draws of all experiments together.
    pub budget: Option<u64>,
    /// Number of blocks of 2¹⁴ draws that are drawn, kept and merged as one; the gate looks between them.
    pub blocks_per_look: u64,
    /// Draw exactly the planned numbers: the gate stops no drawing.
    pub fixed: bool,
    /// True if each check that is underpowered makes its experiment inconclusive.
    pub strict: bool,
    /// Stop an experiment as soon as the check of this name has failed.
    pub until_failed: Option<CheckId>,
    /// Only these experiments.
    pub filter: Option<Filter>,
}

/// Number of draws of an experiment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Amount {
    /// This number, whatever the cases say.
    Exactly(u64),
    /// The number of the case, or this number if the case has none.
    CaseOr(u64),
}

impl Amount {
    /// Returns the number of draws of an experiment; `case` is the number of its case.
    pub(crate) fn of(self, case: Option<u64>) -> u64 {
        match self {
            Self::Exactly(draws) => draws,
            Self::CaseOr(draws) => case.unwrap_or(draws),
        }
    }
}

impl Options {
    /// Returns the options of the command line that ask for the same draws.
    pub fn words(&self) -> Vec<String> {
        let mut words = vec![format!("--seed={}", self.seed), format!("--alpha={}", self.alpha)];
        if let Amount::Exactly(draws) = self.draws {
            words.push(format!("--draws={draws}"));
        }
        words.extend(self.budget.map(|draws| format!("--budget={draws}")));
        words.extend(self.filter.as_ref().map(|filter| format!("--filter={}", filter.pattern())));
        if self.blocks_per_look != 1 {
            words.push(format!("--blocks-per-look={}", self.blocks_per_look));
        }
        let flags = [("--fixed-draws", self.fixed), ("--strict", self.strict)];
        words.extend(flags.iter().filter(|flag| flag.1).map(|flag| flag.0.to_owned()));
        words
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            seed: 1,
            draws: Amount::CaseOr(DRAWS),
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

/// Pattern that selects experiments by name.
///
/// It is matched against the case's name, against the estimator's name without its settings, and
/// against both as `case:estimator`; `*` also crosses slashes.
#[derive(Debug, Clone)]
pub struct Filter(Pattern);

impl Filter {
    /// Parses a pattern such as `*eq21*`, `ratio` or `transmittance/*:single`.
    ///
    /// # Errors
    ///
    /// The pattern is malformed.
    pub fn new(pattern: &str) -> Result<Self, PatternError> {
        Pattern::new(pattern).map(Self)
    }

    /// Returns the pattern as it was written.
    pub fn pattern(&self) -> &str {
        self.0.as_str()
    }

    /// Returns whether an estimator of a case matches.
    pub fn keeps(&self, case: &str, estimator: &EstimatorName) -> bool {
        let (name, label) = (&estimator.name, estimator.to_string());
        let matches = |text: &str| self.0.matches(text);
        matches(case)
            || matches(name)
            || matches(&label)
            || matches(&format!("{case}:{name}"))
            || matches(&format!("{case}:{label}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_meet_cases_estimators_and_both() {
        let keeps = |pattern: &str| {
            let filter = Filter::new(pattern).expect("a pattern");
            let estimator = EstimatorName { name: "single".into(), settings: "terminating".into() };
            filter.keeps("transmittance/eq21-sweep", &estimator)
        };
        assert!(keeps("*eq21*") && keeps("single") && keeps("*sweep:single"));
        assert!(!keeps("double") && !keeps("*noise*"));
    }
}

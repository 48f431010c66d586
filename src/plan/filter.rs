//! Which experiments of the cases are meant.

use crate::case::names::EstimatorName;
use glob::{Pattern, PatternError};

/// A pattern that selects experiments by name.
///
/// It is matched against the case's name, against the estimator's name without its settings, and
/// against both as `case:estimator`; `*` also crosses slashes.
#[derive(Debug, Clone)]
pub struct Filter(Pattern);

impl Filter {
    /// A pattern such as `*eq21*`, `ratio` or `transmittance/*:single`.
    ///
    /// # Errors
    ///
    /// The pattern is malformed.
    pub fn new(pattern: &str) -> Result<Self, PatternError> {
        Pattern::new(pattern).map(Self)
    }

    /// The pattern as it was written.
    pub fn pattern(&self) -> &str {
        self.0.as_str()
    }

    /// Whether an estimator of a case matches.
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

//! Which experiments of the cases are meant.

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

    /// Whether an experiment is meant; `estimator` is its label, settings included.
    pub fn keeps(&self, case: &str, estimator: &str) -> bool {
        let name = estimator.split(' ').next().unwrap_or_default();
        let matches = |text: &str| self.0.matches(text);
        matches(case)
            || matches(name)
            || matches(estimator)
            || matches(&format!("{case}:{name}"))
            || matches(&format!("{case}:{estimator}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_meet_cases_estimators_and_both() {
        let keeps = |pattern: &str| {
            let filter = Filter::new(pattern).expect("a pattern");
            filter.keeps("transmittance/eq21-sweep", "single (terminating)")
        };
        assert!(keeps("*eq21*") && keeps("single") && keeps("*sweep:single"));
        assert!(!keeps("double") && !keeps("*noise*"));
    }
}

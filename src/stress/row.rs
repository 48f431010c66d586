//! The worst of many trials of one quantity.

/// What an error is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// `|found − exact|/|exact|`.
    Relative,
    /// `|found − exact|`.
    Absolute,
    /// `|found − exact|` in units of the stated bound.
    OfStated,
    /// In standard deviations of one draw.
    Deviations,
    /// `−log₁₀` of a p-value.
    Improbability,
    /// How many were wrong.
    Count,
}

impl Measure {
    /// The words in tables.
    pub fn words(self) -> &'static str {
        match self {
            Self::Relative => "relative",
            Self::Absolute => "absolute",
            Self::OfStated => "of stated error",
            Self::Deviations => "deviations",
            Self::Improbability => "−log₁₀ p",
            Self::Count => "count",
        }
    }
}

/// The worst of many trials of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What was computed.
    pub quantity: String,
    /// The range that was tried.
    pub range: String,
    /// How many trials.
    pub trials: u64,
    /// How many more were drawn and gave nothing to compare: refused, out of range, unknown.
    pub skipped: u64,
    /// The first of those.
    pub first_skipped: String,
    /// What the error is measured in.
    pub measure: Measure,
    /// The largest error; not a number once one was none.
    pub worst: f64,
    /// What it may be.
    pub bound: f64,
    /// Where the largest error was.
    pub place: String,
}

impl Row {
    /// Before the first trial.
    pub fn new(
        quantity: impl Into<String>,
        range: impl Into<String>,
        measure: Measure,
        bound: f64,
    ) -> Self {
        let (quantity, range) = (quantity.into(), range.into());
        let (place, first_skipped) = Default::default();
        let (trials, skipped, worst) = (0, 0, 0.0);
        Self { quantity, range, trials, skipped, first_skipped, measure, worst, bound, place }
    }

    /// In units of the stated error.
    pub fn stated(quantity: impl Into<String>, range: impl Into<String>) -> Self {
        Self::new(quantity, range, Measure::OfStated, 1.0)
    }

    /// Variance and fourth moment of draws, in units of their stated errors.
    pub fn moments(of: &str, range: &str) -> [Self; 2] {
        ["variance", "fourth moment"].map(|what| Self::stated(format!("{what} of {of}"), range))
    }

    /// Relative to what is exact.
    pub fn relative(quantity: impl Into<String>, range: impl Into<String>, bound: f64) -> Self {
        Self::new(quantity, range, Measure::Relative, bound)
    }

    /// Of which none may be wrong.
    pub fn wrong(quantity: impl Into<String>, range: impl Into<String>) -> Self {
        Self::new(quantity, range, Measure::Count, 0.0)
    }

    /// Independent random numbers: one false alarm in a million.
    pub fn improbable(quantity: impl Into<String>, range: impl Into<String>) -> Self {
        Self::new(quantity, range, Measure::Improbability, 6.0)
    }

    /// Parameters that gave nothing to compare.
    pub fn skip(&mut self, place: impl FnOnce() -> String) {
        if self.skipped == 0 {
            self.first_skipped = place();
        }
        self.skipped += 1;
    }

    /// One trial.
    pub fn see(&mut self, error: f64, place: impl FnOnce() -> String) {
        self.trials += 1;
        if !self.worst.is_nan() && (error.is_nan() || error > self.worst || self.trials == 1) {
            (self.worst, self.place) = (error, place());
        }
    }

    /// One trial of which only right or wrong is known.
    pub fn count(&mut self, is_wrong: bool, place: impl FnOnce() -> String) {
        self.trials += 1;
        if is_wrong {
            if self.worst == 0.0 {
                self.place = place();
            }
            self.worst += 1.0;
        }
    }

    /// Adds the trials of a later part of the same quantity.
    #[must_use]
    pub fn and(mut self, later: Self) -> Self {
        self.trials += later.trials;
        if self.skipped == 0 {
            self.first_skipped = later.first_skipped;
        }
        self.skipped += later.skipped;
        if self.measure == Measure::Count {
            if self.worst == 0.0 {
                self.place = later.place;
            }
            self.worst += later.worst;
        } else if !self.worst.is_nan() && (later.worst.is_nan() || later.worst > self.worst) {
            (self.worst, self.place) = (later.worst, later.place);
        }
        self
    }

    /// Whether the bound holds. What was never tried does not, nor what was mostly skipped.
    pub fn holds(&self) -> bool {
        self.trials > 0 && !self.is_mostly_skipped() && self.worst <= self.bound
    }

    /// Whether more was skipped than compared: such a row says nothing of its range.
    pub fn is_mostly_skipped(&self) -> bool {
        self.skipped > self.trials
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_keeps_the_worst_and_what_is_no_number() {
        let mut row = Row::new("q", "r", Measure::Relative, 1e-9);
        assert!(!row.holds(), "nothing was tried");
        row.see(1e-12, || "a".into());
        row.see(1e-10, || "b".into());
        row.see(1e-11, || "c".into());
        assert!(row.holds() && row.place == "b" && row.trials == 3);
        let mut later = Row::new("q", "r", Measure::Relative, 1e-9);
        later.see(f64::NAN, || "d".into());
        later.see(1.0, || "e".into());
        let both = row.and(later);
        assert!(both.worst.is_nan() && both.place == "d" && !both.holds());
    }

    #[test]
    fn one_wrong_verdict_is_too_many() {
        let mut row = Row::new("q", "r", Measure::Count, 0.0);
        row.count(false, || "a".into());
        assert!(row.holds());
        let mut later = row.clone();
        later.count(true, || "b".into());
        let both = row.and(later);
        assert!(!both.holds() && both.place == "b" && both.worst == 1.0);
    }

    #[test]
    fn what_is_mostly_skipped_does_not_hold() {
        let mut row = Row::new("q", "r", Measure::Relative, 1e-9);
        row.see(0.0, || "a".into());
        row.skip(|| "b".into());
        assert!(row.holds() && row.first_skipped == "b");
        let mut later = Row::new("q", "r", Measure::Relative, 1e-9);
        later.skip(|| "c".into());
        let both = row.and(later);
        assert!(!both.holds() && both.skipped == 2 && both.first_skipped == "b");
    }
}

//! A row of the table: the worst error of many trials of one quantity, and its bound.

use super::tally::Tally;

/// Unit of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// `|found − exact|/|exact|`.
    Relative,
    /// `|found − exact|`.
    Absolute,
    /// `|found − exact|` in units of the stated error.
    OfStated,
    /// Standard deviations of one draw.
    Deviations,
    /// Number of wrong answers.
    Count,
}

impl Measure {
    /// Returns the words in tables.
    pub fn words(self) -> &'static str {
        match self {
            Self::Relative => "relative",
            Self::Absolute => "absolute",
            Self::OfStated => "of stated error",
            Self::Deviations => "deviations",
            Self::Count => "count",
        }
    }
}

/// The worst error of many trials of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Quantity of the library.
    pub quantity: String,
    /// Range of the parameters.
    pub range: String,
    /// Number of trials.
    pub trials: u64,
    /// Number of trials without anything to compare: refused, out of range, unknown.
    pub skipped: u64,
    /// Parameters of the first of those.
    pub first_skipped: String,
    /// Unit of the error.
    pub measure: Measure,
    /// Largest error; NaN once one was NaN.
    pub worst: f64,
    /// Bound of the error.
    pub bound: f64,
    /// Parameters of the largest error.
    pub place: String,
}

impl Row {
    /// A row without trials.
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

    /// A row in units of the stated error.
    pub fn stated(quantity: impl Into<String>, range: impl Into<String>) -> Self {
        Self::new(quantity, range, Measure::OfStated, 1.0)
    }

    /// Rows of variance and fourth moment of draws, in units of their stated errors.
    pub fn moments(of: &str, range: &str) -> [Self; 2] {
        ["variance", "fourth moment"].map(|what| Self::stated(format!("{what} of {of}"), range))
    }

    /// A row relative to the exact value.
    pub fn relative(quantity: impl Into<String>, range: impl Into<String>, bound: f64) -> Self {
        Self::new(quantity, range, Measure::Relative, bound)
    }

    /// A row of which no answer may be wrong.
    pub fn wrong(quantity: impl Into<String>, range: impl Into<String>) -> Self {
        Self::new(quantity, range, Measure::Count, 0.0)
    }

    /// A tally for the trials of this row.
    pub(super) fn tally<P>(&self) -> Tally<P> {
        Tally::new(self.measure == Measure::Count)
    }

    /// This row with the trials of a tally.
    pub(super) fn with<P>(&self, tally: &Tally<P>, shown: impl Fn(&P) -> String) -> Self {
        let [place, first_skipped] = [&tally.place, &tally.first_skipped]
            .map(|place| place.as_ref().map_or_else(String::new, &shown));
        let &Tally { trials, skipped, worst, .. } = tally;
        Self { trials, skipped, first_skipped, worst, place, ..self.clone() }
    }

    /// The worst error is within the bound; NaN is not.
    pub fn is_within(&self) -> bool {
        self.worst <= self.bound
    }

    /// The bound holds. A row without trials does not hold, nor one that was mostly skipped.
    pub fn holds(&self) -> bool {
        self.trials > 0 && !self.is_mostly_skipped() && self.is_within()
    }

    /// More trials were skipped than compared: such a row says nothing of its range.
    pub fn is_mostly_skipped(&self) -> bool {
        self.skipped > self.trials
    }
}

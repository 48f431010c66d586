//! A row of the table: the worst error of many trials of one quantity, and its bound.

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
    /// Returns the name in tables.
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
pub struct TrialRow {
    /// Quantity of the library.
    pub quantity: String,
    /// Range of the parameters.
    pub range: String,
    /// Unit of the error.
    pub measure: Measure,
    /// Bound of the error.
    pub bound: f64,
    /// Number of trials.
    pub trials: u64,
    /// Largest error, or number of wrong answers; NaN once an error was NaN.
    pub worst: f64,
    /// Number of the trial of the largest error, or of the first wrong answer.
    pub trial: u32,
    /// Parameters of that trial.
    pub place: String,
    /// Number of trials without anything to compare: refused, out of range, unknown.
    pub skipped: u64,
    /// Parameters of the first of those.
    pub first_skipped: String,
}

impl TrialRow {
    /// A row without trials.
    pub fn new(
        quantity: impl Into<String>,
        range: impl Into<String>,
        measure: Measure,
        bound: f64,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            range: range.into(),
            measure,
            bound,
            trials: 0,
            worst: 0.0,
            trial: 0,
            place: String::new(),
            skipped: 0,
            first_skipped: String::new(),
        }
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

    /// A row that allows no wrong answer.
    pub fn wrong(quantity: impl Into<String>, range: impl Into<String>) -> Self {
        Self::new(quantity, range, Measure::Count, 0.0)
    }

    /// Adds an error of a trial.
    pub fn see(&mut self, error: f64, trial: u32, place: impl FnOnce() -> String) {
        self.add(1, error, || (trial, place()));
    }

    /// Adds a trial without anything to compare.
    pub(super) fn skip(&mut self, place: impl FnOnce() -> String) {
        if self.skipped == 0 {
            self.first_skipped = place();
        }
        self.skipped += 1;
    }

    /// Adds later trials of this row.
    pub fn merge(&mut self, later: Self) {
        if self.skipped == 0 {
            self.first_skipped = later.first_skipped;
        }
        self.skipped += later.skipped;
        self.add(later.trials, later.worst, || (later.trial, later.place));
    }

    /// Adds trials with their largest error, or with their number of wrong answers.
    fn add(&mut self, trials: u64, worst: f64, place: impl FnOnce() -> (u32, String)) {
        let is_count = self.measure == Measure::Count;
        let is_worse = if is_count {
            self.worst == 0.0 && worst > 0.0
        } else {
            let is_larger = self.trials == 0 || worst > self.worst || worst.is_nan();
            trials > 0 && is_larger && !self.worst.is_nan()
        };
        if is_worse {
            (self.trial, self.place) = place();
        }
        if is_count {
            self.worst += worst;
        } else if is_worse {
            self.worst = worst;
        }
        self.trials += trials;
    }

    /// Returns whether the worst error is within the bound; NaN is not.
    pub fn is_within(&self) -> bool {
        self.worst <= self.bound
    }

    /// Returns whether the bound holds. A row without trials does not hold, nor one that was mostly skipped.
    pub fn holds(&self) -> bool {
        self.trials > 0 && !self.is_mostly_skipped() && self.is_within()
    }

    /// Returns whether more trials were skipped than compared: such a row does not test its range.
    pub fn is_mostly_skipped(&self) -> bool {
        self.skipped > self.trials
    }
}

//! Worst error of many trials.

/// Worst error of many trials, and its place.
#[derive(Debug, Clone)]
pub(super) struct Tally<P> {
    /// Errors are counted, not compared.
    is_count: bool,
    /// Number of trials.
    pub trials: u64,
    /// Number of trials without anything to compare.
    pub skipped: u64,
    /// Place of the first of those.
    pub first_skipped: Option<P>,
    /// Largest error, or number of errors; NaN once one was NaN.
    pub worst: f64,
    /// Place of the largest error, or of the first.
    pub place: Option<P>,
}

impl<P> Tally<P> {
    /// A tally without trials.
    pub fn new(is_count: bool) -> Self {
        Self { is_count, trials: 0, skipped: 0, first_skipped: None, worst: 0.0, place: None }
    }

    /// Adds an error.
    pub fn see(&mut self, error: f64, place: impl FnOnce() -> P) {
        let is_worse = self.is_worse(1, error);
        let place = is_worse.then(place);
        self.merge(Self { trials: 1, worst: error, place, ..Self::new(self.is_count) });
    }

    /// Adds a trial without anything to compare.
    pub fn skip(&mut self, place: impl FnOnce() -> P) {
        self.skipped += 1;
        self.first_skipped.get_or_insert_with(place);
    }

    /// The place of later trials replaces that of these.
    fn is_worse(&self, trials: u64, worst: f64) -> bool {
        if self.is_count {
            return self.worst == 0.0 && worst > 0.0;
        }
        let is_larger = worst > self.worst || worst.is_nan() || self.trials == 0;
        is_larger && trials > 0 && !self.worst.is_nan()
    }

    /// Adds later trials.
    pub fn merge(&mut self, later: Self) {
        if self.is_worse(later.trials, later.worst) {
            self.place = later.place;
            self.worst = if self.is_count { 0.0 } else { later.worst };
        }
        self.worst += if self.is_count { later.worst } else { 0.0 };
        self.trials += later.trials;
        self.skipped += later.skipped;
        self.first_skipped = self.first_skipped.take().or(later.first_skipped);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tally(is_count: bool, errors: &[f64]) -> Tally<usize> {
        let mut tally = Tally::new(is_count);
        errors.iter().zip(0..).for_each(|(&error, place)| tally.see(error, || place));
        tally
    }

    #[test]
    fn the_worst_error_is_kept_and_nan_is_the_worst() {
        let mut all = tally(false, &[1e-12, 1e-10, 1e-11]);
        assert_eq!((all.worst, all.place, all.trials), (1e-10, Some(1), 3));
        all.merge(tally(false, &[f64::NAN, 1.0]));
        assert!(all.worst.is_nan() && all.place == Some(0) && all.trials == 5);
    }

    #[test]
    fn wrong_answers_are_counted_and_the_first_is_kept() {
        let mut all = tally(true, &[0.0, 0.0, 1.0]);
        all.merge(tally(true, &[1.0, 1.0]));
        assert_eq!((all.worst, all.place), (3.0, Some(2)));
    }
}

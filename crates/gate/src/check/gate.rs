//! Several checks that share one α.

use super::builder::Check;
use super::error::CheckError;
use super::made::{Closure, Factory};
use super::outcome::Outcome;
use super::sample::Sample;
use numeric::rng::Stream;

/// A check that is ready to draw.
pub trait Planned {
    /// Draws and judges with this α in place of the check's own.
    ///
    /// # Errors
    ///
    /// See [`CheckError`].
    fn verdict_at(self: Box<Self>, alpha: f64) -> Result<Outcome, CheckError>;
}

impl<T: Sample, F: FnMut(&mut Stream) -> T> Planned for Check<Closure<F>> {
    fn verdict_at(self: Box<Self>, alpha: f64) -> Result<Outcome, CheckError> {
        self.alpha(alpha).verdict()
    }
}

impl<T: Sample, F: FnMut(&mut Stream) -> T, M: Fn() -> F + Sync> Planned for Check<Factory<M>> {
    fn verdict_at(self: Box<Self>, alpha: f64) -> Result<Outcome, CheckError> {
        self.alpha(alpha).verdict()
    }
}

/// Checks that share one α: where all estimators are correct, any of them fails with chance α at most. Each has an
/// equal share.
///
/// ```
/// use trueflight_gate::{Gate, check};
///
/// Gate::new()
///     .check(check("u", |rng| rng.uniform()).truth(0.5).range(0.0, 1.0))
///     .check(check("u²", |rng| rng.uniform().powi(2)).truth(1.0 / 3.0).range(0.0, 1.0))
///     .assert_pass();
/// ```
#[must_use = "a gate draws nothing before .verdicts() or .assert_pass()"]
pub struct Gate<'a> {
    alpha: f64,
    checks: Vec<Box<dyn Planned + 'a>>,
}

impl Default for Gate<'_> {
    fn default() -> Self {
        Self { alpha: 1e-3, checks: Vec::new() }
    }
}

impl<'a> Gate<'a> {
    /// A gate without checks, α = 1e-3.
    pub fn new() -> Self {
        Self::default()
    }

    /// The chance that any of the checks fails where all estimators are correct.
    pub fn alpha(mut self, alpha: f64) -> Self {
        self.alpha = alpha;
        self
    }

    /// One check more; its own α does not count.
    pub fn check(mut self, check: impl Planned + 'a) -> Self {
        self.checks.push(Box::new(check));
        self
    }

    /// The verdicts, in the order of the checks.
    pub fn verdicts(self) -> Vec<Result<Outcome, CheckError>> {
        // What is no probability is told by each check, undivided.
        let is_one = self.alpha > 0.0 && self.alpha < 1.0;
        let share = if is_one { self.alpha / self.checks.len() as f64 } else { self.alpha };
        self.checks.into_iter().map(|check| check.verdict_at(share)).collect()
    }

    /// Draws and judges all of them; panics unless all pass.
    ///
    /// # Panics
    ///
    /// Any verdict is fail or inconclusive, or there is none.
    #[track_caller]
    pub fn assert_pass(self) {
        assert!(
            !self.checks.is_empty(),
            "a gate without checks tests nothing; add one by .check(…)"
        );
        let all = self.checks.len();
        let verdicts = self.verdicts();
        let said = verdicts.iter().filter_map(|verdict| match verdict {
            Ok(outcome) if outcome.passed() => None,
            Ok(outcome) => Some(outcome.to_string()),
            Err(error) => Some(error.to_string()),
        });
        let said: Vec<String> = said.collect();
        let count = said.len();
        assert!(said.is_empty(), "{count} of {all} checks do not pass\n{}", said.join("\n"));
    }
}

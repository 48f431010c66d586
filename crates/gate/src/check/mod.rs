//! Is my estimator unbiased? Three lines in one's own test.
//!
//! [`check`] draws from a closure, [`check_with`] from one closure for each thread, and [`claim`] takes draws that
//! are pushed. The properties of a correct draw are given by numbers ([`Check::truth`], [`Check::variance`],
//! [`Check::kurtosis`], [`Check::range`]), or taken from theory for an experiment of a case (`Check::of`). Then the
//! gate of `trueflight judge` decides: pass, fail or inconclusive. A correct estimator fails with probability α at
//! most. [`Gate`] shares one α among several checks.
//!
//! ```
//! // The transmittance of a homogeneous medium of depth 1: does a photon fly farther than 1?
//! trueflight_gate::check("analogue", |rng| f64::from(-rng.positive_uniform().ln() > 1.0))
//!     .truth((-1.0f64).exp())
//!     .range(0.0, 1.0)
//!     .assert_pass();
//! ```
//!
//! Draws come in blocks of 2¹⁴, and each block has a random stream of its own, addressed by seed, name and block. A
//! closure that uses no other source of randomness makes the same draws on any number of threads. Without
//! [`Check::draws`] they end as soon as all is decided, and after [`MAX_DRAWS`] draws at the latest.

mod builder;
mod made;
mod outcome;
mod property;
mod pushed;
mod sample;

pub use builder::{Check, MAX_DRAWS, PerValue, check, check_with, claim};
pub use outcome::{CheckError, CheckFault, MAX_VALUES, Outcome};
pub use property::Property;
pub use pushed::{BlockRequest, Pushed};
pub use sample::{Closure, Factory, Sample};

pub use crate::session::{Block, Source, Stop, Until};

use numeric::rng::Stream;

/// A check that is ready to draw.
pub trait PlannedCheck {
    /// Draws and judges with this α in place of the check's own.
    ///
    /// # Errors
    ///
    /// See [`CheckError`].
    fn verdict_at(self: Box<Self>, alpha: f64) -> Result<Outcome, CheckError>;
}

impl<T: Sample, F: FnMut(&mut Stream) -> T> PlannedCheck for Check<Closure<F>> {
    fn verdict_at(self: Box<Self>, alpha: f64) -> Result<Outcome, CheckError> {
        self.alpha(alpha).verdict()
    }
}

impl<T: Sample, F: FnMut(&mut Stream) -> T, M: Fn() -> F + Sync> PlannedCheck
    for Check<Factory<M>>
{
    fn verdict_at(self: Box<Self>, alpha: f64) -> Result<Outcome, CheckError> {
        self.alpha(alpha).verdict()
    }
}

/// Checks that share one α: where all estimators are correct, any of them fails with probability α at most. Each has an
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
    checks: Vec<Box<dyn PlannedCheck + 'a>>,
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

    /// The probability that any of the checks fails where all estimators are correct.
    pub fn alpha(mut self, alpha: f64) -> Self {
        self.alpha = alpha;
        self
    }

    /// Adds a check; its own α is not used.
    pub fn check(mut self, check: impl PlannedCheck + 'a) -> Self {
        self.checks.push(Box::new(check));
        self
    }

    /// The verdicts, in the order of the checks.
    pub fn verdicts(self) -> Vec<Result<Outcome, CheckError>> {
        // An invalid α is reported by each check, undivided.
        let is_one = self.alpha > 0.0 && self.alpha < 1.0;
        let share = if is_one { self.alpha / self.checks.len() as f64 } else { self.alpha };
        self.checks.into_iter().map(|check| check.verdict_at(share)).collect()
    }

    /// Draws and judges all checks; panics unless all pass.
    ///
    /// # Panics
    ///
    /// Any verdict is fail or inconclusive, or there are no verdicts.
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

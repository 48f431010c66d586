//! What is asked of the draws, one check per page.
//!
//! A check says beforehand whether it applies and how many hypotheses it tests; the levels are then
//! shared among all checks of the run, before the first draw. It may ask for sums of its own over
//! the draws; means, variances and lookups are summed for all.

use super::case::Tolerance;
use super::record::{Finding, Verdict};
use crate::catalogue::Catalogue;
use crate::estimators::DrawBuffer;
use crate::numeric::sum::Sum;
use crate::stats::Tally;
use crate::theory::Prediction;

/// What a check tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A mean against its prediction, by a z-score.
    Scalar,
    /// A whole law, by a p-value.
    Law,
}

/// What a check knows before the first draw.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// What theory says.
    pub prediction: &'a Prediction,
    /// How many draws will be made.
    pub draws: u64,
    /// The differences that matter.
    pub tolerance: Tolerance,
    /// Whether the case declares the experiment biased.
    pub expect_biased: bool,
    /// Whether the case allows checks that are too short to pass.
    pub allow_underpowered: bool,
}

/// The levels that the run's checks share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A z-score beyond this fails.
    pub z: f64,
    /// A p-value below this fails.
    pub p: f64,
    /// A difference of `z + power` standard errors is seen all but β of the time.
    pub power: f64,
}

/// What was drawn.
pub struct Evidence<'a> {
    /// One tally per channel, of draws less the predicted mean in units of the truth.
    pub tallies: &'a [Tally],
    /// The tally of the lookups, less the predicted mean.
    pub lookups: &'a Tally,
    /// The sums that the check asked for.
    pub sums: &'a [Sum],
}

/// Sums over draws that a check asks for.
pub trait Statistic: Send + Sync {
    /// How many sums.
    fn size(&self) -> usize;

    /// Adds the draws of a buffer to the sums.
    fn add(&self, draws: &DrawBuffer, sums: &mut [f64]);
}

/// A page of the catalogue of checks.
pub trait Check: Sync {
    /// What it tests.
    fn kind(&self) -> Kind;

    /// How many hypotheses it tests of an experiment; 0 where it does not apply.
    fn hypotheses(&self, subject: &Subject) -> usize;

    /// The sums it needs.
    fn statistic(&self, subject: &Subject) -> Option<Box<dyn Statistic>> {
        let _ = subject;
        None
    }

    /// What it found.
    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding>;
}

/// Lists the checks: from one line each come the module, the name and the row in `list`.
macro_rules! checks {
    ($($module:ident :: $Page:ident,)*) => {
        $(pub mod $module;)*

        /// Every check, in the order of registration.
        pub const CATALOGUE: Catalogue =
            Catalogue { name: "checks", pages: &[$($crate::page!($module)),*] };

        /// The checks, in the order of the catalogue.
        pub const ALL: &[&dyn Check] = &[$(&$module::$Page),*];
    };
}

checks! {
    mean::Mean,
    variance::Variance,
    lookups::Lookups,
    poisson::Poisson,
    atoms::Atoms,
    distances::Distances,
    covariance::Covariance,
}

/// Rounding of a product of `lookups` factors, relative to the result.
#[must_use]
pub fn rounding(lookups: f64) -> f64 {
    16.0 * f64::EPSILON * (1.0 + lookups)
}

/// A mean that was compared with its prediction.
#[derive(Debug, Clone, Copy)]
pub struct Comparison {
    /// Observed less predicted.
    pub difference: f64,
    /// The predicted standard error of the difference.
    pub standard_error: f64,
    /// The prediction's own error bound.
    pub allowance: f64,
    /// The difference that matters.
    pub tolerance: f64,
    /// The fewest draws for which the test is near its level, whatever the tolerance.
    pub draws_for_level: f64,
}

impl Comparison {
    /// The z-score.
    #[must_use]
    pub fn z(&self) -> f64 {
        self.difference / self.standard_error
    }

    /// Whether the difference is within the prediction's own error.
    #[must_use]
    pub fn is_rounding(&self) -> bool {
        self.difference.abs() <= self.allowance
    }

    /// The smallest difference that would have been seen.
    #[must_use]
    pub fn detectable(&self, limits: &Limits) -> f64 {
        (limits.z + limits.power) * self.standard_error
    }

    /// Fail beyond the level and the prediction's own error; pass if a difference that matters
    /// would have been seen; otherwise inconclusive, with the draws it would need.
    #[must_use]
    pub fn verdict(&self, what: &str, subject: &Subject, limits: &Limits) -> (Verdict, String) {
        let draws = subject.draws as f64;
        let beyond = self.difference.abs() - self.allowance;
        let sound = draws >= self.draws_for_level;
        if sound && beyond > limits.z * self.standard_error {
            let z = self.z();
            return (Verdict::Fail, format!("{what} is off by {z:+.1} standard errors"));
        }
        let room = self.tolerance - self.allowance;
        if room <= 0.0 {
            let reason =
                format!("the prediction of {what} is known to {:.0e} only", self.allowance);
            return (too_short(subject), reason);
        }
        let needed = draws * (self.detectable(limits) / room).powi(2);
        let needed = needed.max(self.draws_for_level);
        if needed <= draws * (1.0 + 1e-9) {
            return (Verdict::Pass, String::new());
        }
        let reason = if needed.is_finite() {
            format!("{what} needs {needed:.1e} draws")
        } else {
            format!("{what} cannot be tested: its moments overflow")
        };
        (too_short(subject), reason)
    }
}

/// The verdict on a check that has too few draws.
#[must_use]
pub fn too_short(subject: &Subject) -> Verdict {
    if subject.allow_underpowered { Verdict::Underpowered } else { Verdict::Inconclusive }
}

/// A finding about a p-value.
#[must_use]
pub fn law_finding(check: &str, what: &str, p: Option<f64>, limits: &Limits) -> Option<Finding> {
    let p = p?;
    let fails = p < limits.p;
    let verdict = if fails { Verdict::Fail } else { Verdict::Pass };
    let reason = if fails { format!("{what}: p = {p:.1e}") } else { String::new() };
    let channel = String::new();
    Some(Finding { check: check.to_owned(), channel, z: None, p: Some(p), verdict, reason })
}

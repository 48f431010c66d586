//! Checks of draws, one page each.
//!
//! A check turns the prediction of an experiment into questions before the first draw: the levels are then shared among
//! all questions of the run. Each question has an answer, a [`check::Check`]. Quantities for the gate ([`scalar`]) may
//! stop the drawing; distributions ([`distribution`]) have a p-value on a number of draws fixed beforehand; a bound ([`always`])
//! must hold for every draw; and an inspection ([`distribution::Inspection`]) looks at the streams of random numbers themselves.
//!
//! From bottom to top: [`batch`], [`check`], the kinds, the pages.

pub mod always;
pub mod atoms;
pub mod batch;
pub mod check;
pub mod counts;
pub mod covariance;
pub mod curve;
pub mod depth;
pub mod dispersion;
pub mod distances;
pub mod distribution;
pub mod generator;
pub mod invariant;
pub mod lookups;
pub mod mean;
pub mod normality;
pub mod numeric;
pub mod resolution;
pub mod scalar;
pub mod streams;
pub mod variance;

use gate::CheckId;
use media::catalogue::PageList;

pub use batch::Observe;
pub use check::{Check, Pilot, Question, Subject, rounding};
pub use distribution::{DistributionTest, Inspected};
pub use scalar::Scalar;

/// Smallest relative differences that must be detected; `None` where the case does not give them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tolerance {
    /// Tolerance of the mean, relative to the truth.
    pub mean: Option<f64>,
    /// Tolerance of the variance, relative to the prediction.
    pub variance: Option<f64>,
    /// Tolerance of the lookups, relative to the prediction.
    pub lookups: Option<f64>,
}

impl Tolerance {
    /// Returns whether the case gives any tolerance.
    pub fn is_given(&self) -> bool {
        *self != Self::default()
    }
}

/// Page of the catalogue of checks.
struct Page {
    /// The check.
    id: CheckId,
    /// Returns its questions about an experiment; none where it does not apply.
    questions: fn(&Subject) -> Vec<Question>,
    /// True if it also applies to experiments that a case declares biased.
    of_biased: bool,
    /// True if the p-values of correct draws are uniform; otherwise their probability to be at most p is below p.
    is_uniform: bool,
}

impl Page {
    const fn new(id: CheckId, questions: fn(&Subject) -> Vec<Question>) -> Self {
        Self { id, questions, of_biased: false, is_uniform: true }
    }

    /// Applies the check to experiments that a case declares biased, too.
    const fn of_biased(self) -> Self {
        Self { of_biased: true, ..self }
    }

    /// Declares that the p-values of correct draws are not uniform: the probability of p or less is below p.
    const fn not_uniform(self) -> Self {
        Self { is_uniform: false, ..self }
    }
}

/// Returns all questions of all checks, in the order of the catalogue.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let asking = ALL.iter().filter(|page| page.of_biased || !subject.expect_biased);
    let asked = asking.flat_map(|page| {
        let expects_bias = subject.expect_biased && page.id == CheckId::Mean;
        let questions = (page.questions)(subject).into_iter();
        questions.map(move |question| Question { expects_bias, ..question })
    });
    asked.collect()
}

/// Returns whether the p-values of a check are uniform for correct draws.
pub fn is_uniform(check: CheckId) -> bool {
    ALL.iter().any(|page| page.id == check && page.is_uniform)
}

/// Lists the checks: each line gives the module, which is the row in `list`, the check, and the experiments to which the check applies.
macro_rules! checks {
    ($($module:ident $Id:ident $($how:ident)*,)*) => {
        /// Every check, in the order of registration.
        pub const CATALOGUE: PageList =
            PageList { name: "checks", pages: &[$(media::page!($module)),*] };

        /// The checks, in the order of the catalogue.
        const ALL: &[Page] = &[$(Page::new(CheckId::$Id, $module::questions)$(.$how())*),*];
    };
}

checks! {
    mean Mean of_biased,
    variance Variance,
    lookups Lookups of_biased,
    covariance Covariance,
    counts Counts of_biased,
    // Two values have an exact binomial distribution, which has discrete p-values.
    atoms Atoms not_uniform,
    distances Distances,
    depth Depth,
    curve Curve not_uniform,
    dispersion Dispersion,
    streams Streams,
    generator Generator not_uniform,
    resolution Resolution not_uniform,
    invariant Invariant,
    numeric Numeric of_biased,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_have_the_names_of_their_checks() {
        let names: Vec<String> = CATALOGUE.pages.iter().map(media::catalogue::Page::name).collect();
        assert_eq!(names, ALL.iter().map(|page| page.id.name()).collect::<Vec<_>>());
        assert_eq!(names, CheckId::ALL.iter().map(|id| id.name()).collect::<Vec<_>>());
    }
}

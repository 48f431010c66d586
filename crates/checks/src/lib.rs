//! Checks of draws, one page each.
//!
//! A check turns the prediction of an experiment into questions before the first draw: the levels are then shared among
//! all questions of the run. Each question has an answer, a [`check::Check`]. Quantities for the gate ([`scalar`]) may
//! stop the drawing; distributions ([`distribution`]) have a p-value on a number of draws fixed beforehand; a bound ([`always`])
//! must hold for every draw; and an inspection ([`distribution::Inspection`]) looks at the streams of random numbers themselves.
//! Pages with a test of a whole distribution also have it for draws of another program ([`foreign`]).
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
pub mod foreign;
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
use media::catalogue::Registry;
use media::registry;

pub use batch::Observe;
pub use check::{Check, Pilot, Question, Subject, rounding};
pub use distribution::{DistributionTest, Inspected};
pub use foreign::{ForeignDraws, ForeignTest};
pub use scalar::ScalarCheck;

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

/// Check of the catalogue, as its page declares it.
pub struct CheckKind {
    /// The check.
    id: CheckId,
    /// Returns its questions about an experiment; none where it does not apply.
    questions: fn(&Subject) -> Vec<Question>,
    /// Returns its tests of foreign draws.
    of_foreign: fn(&ForeignDraws) -> Vec<ForeignTest>,
    /// True if it also applies to experiments that a case declares biased.
    of_biased: bool,
    /// True if the p-values of correct draws are uniform; otherwise their probability to be at most p is below p.
    is_uniform: bool,
}

impl CheckKind {
    const fn new(id: CheckId, questions: fn(&Subject) -> Vec<Question>) -> Self {
        Self { id, questions, of_foreign: |_| Vec::new(), of_biased: false, is_uniform: true }
    }

    /// Applies the check to foreign draws, too.
    const fn of_foreign(self, of_foreign: fn(&ForeignDraws) -> Vec<ForeignTest>) -> Self {
        Self { of_foreign, ..self }
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

/// Every check, in the order of [`CheckId::ALL`].
pub static CATALOGUE: Registry<CheckKind> = registry![
    mean::CHECK,
    variance::CHECK,
    lookups::CHECK,
    covariance::CHECK,
    counts::CHECK,
    atoms::CHECK,
    distances::CHECK,
    depth::CHECK,
    curve::CHECK,
    dispersion::CHECK,
    streams::CHECK,
    generator::CHECK,
    resolution::CHECK,
    invariant::CHECK,
    numeric::CHECK,
];

// A check that only one of the two lists has, or that has another place in it, is an error of the compiler.
const _: () = {
    assert!(
        CATALOGUE.values.len() == CheckId::ALL.len(),
        "`CheckId` and `CATALOGUE` have different checks"
    );
    let mut place = 0;
    while place < CheckId::ALL.len() {
        let is_same = CATALOGUE.values[place].id as usize == CheckId::ALL[place] as usize;
        assert!(is_same, "`CheckId` and `CATALOGUE` have different orders");
        place += 1;
    }
};

/// Returns all questions of all checks, in the order of the catalogue.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let kinds = CATALOGUE.values.iter();
    let asking = kinds.filter(|kind| kind.of_biased || !subject.expect_biased);
    let requested = asking.flat_map(|kind| {
        let expects_bias = subject.expect_biased && kind.id == CheckId::Mean;
        let questions = (kind.questions)(subject).into_iter();
        questions.map(move |question| Question { expects_bias, ..question })
    });
    requested.collect()
}

/// Returns the tests of foreign draws, in the order of the catalogue.
pub fn of_foreign(draws: &ForeignDraws) -> Vec<(CheckId, ForeignTest)> {
    let tests = CATALOGUE
        .values
        .iter()
        .flat_map(|kind| (kind.of_foreign)(draws).into_iter().map(|test| (kind.id, test)));
    tests.collect()
}

/// Returns whether the p-values of a check are uniform for correct draws.
pub fn is_uniform(check: CheckId) -> bool {
    CATALOGUE.values.iter().any(|kind| kind.id == check && kind.is_uniform)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_have_the_names_of_their_checks() {
        assert_eq!(CATALOGUE.names(), CheckId::ALL.iter().map(|id| id.name()).collect::<Vec<_>>());
    }
}

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
    /// Returns its questions about an experiment; none where it does not apply.
    questions: fn(&Subject) -> Vec<Question>,
    /// True if it also applies to experiments that a case declares biased.
    of_biased: bool,
    /// True if the p-values of correct draws are uniform; otherwise their probability to be at most p is below p.
    is_uniform: bool,
}

impl Page {
    const fn new(questions: fn(&Subject) -> Vec<Question>) -> Self {
        Self { questions, of_biased: false, is_uniform: true }
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
    let pages = CATALOGUE.pages.iter().zip(ALL);
    let asking = pages.filter(|(_, check)| check.of_biased || !subject.expect_biased);
    let asked = asking.flat_map(|(page, check)| {
        let check_name = page.name();
        let expects_bias = subject.expect_biased && check_name == "mean";
        let questions = (check.questions)(subject).into_iter();
        questions.map(move |question| Question {
            check: check_name.clone(),
            expects_bias,
            ..question
        })
    });
    asked.collect()
}

/// Returns whether the p-values of the check of that name are uniform for correct draws.
pub fn is_uniform(name: &str) -> bool {
    let named = CATALOGUE.pages.iter().zip(ALL).find(|(page, _)| page.name() == name);
    named.is_some_and(|(_, check)| check.is_uniform)
}

/// Lists the checks: each line gives the name, the row in `list`, and the experiments to which the check applies.
macro_rules! checks {
    ($($module:ident $($how:ident)*,)*) => {
        /// Every check, in the order of registration.
        pub const CATALOGUE: PageList =
            PageList { name: "checks", pages: &[$(media::page!($module)),*] };

        /// The checks, in the order of the catalogue.
        const ALL: &[Page] = &[$(Page::new($module::questions)$(.$how())*),*];
    };
}

checks! {
    mean of_biased,
    variance,
    lookups of_biased,
    covariance,
    counts of_biased,
    // Two values have an exact binomial distribution, which has discrete p-values.
    atoms not_uniform,
    distances,
    depth,
    curve not_uniform,
    dispersion,
    streams,
    generator not_uniform,
    resolution not_uniform,
    invariant,
    numeric of_biased,
}

//! What is asked of the draws, one check per page.
//!
//! A check turns what theory says of an experiment into questions, all of them before the first
//! draw: the levels are then shared among all questions of the run. Questions are of four kinds.
//! Scalars go through the sequential gate and may stop the drawing; laws are tested by a p-value on
//! a number of draws fixed beforehand; what must hold for every draw is watched on every draw; and
//! the streams of random numbers are looked at themselves.
//!
//! From bottom to top: [`observe`], [`batch`], [`question`], the pages.

pub mod atoms;
pub mod batch;
pub mod counts;
pub mod covariance;
pub mod curve;
pub mod depth;
pub mod dispersion;
pub mod distances;
pub mod generator;
pub mod invariant;
pub mod lookups;
pub mod mean;
pub mod numeric;
pub mod observe;
pub mod question;
pub mod resolution;
pub mod streams;
pub mod variance;

use crate::catalogue::Catalogue;

pub use observe::Observe;
pub use question::{
    Always, Check, Inspected, Kind, Law, Pilot, Question, Scalar, Subject, rounding,
};

/// All questions of all checks, in the order of the catalogue.
#[must_use]
pub fn questions(subject: &Subject) -> Vec<Question> {
    let pages = CATALOGUE.pages.iter().zip(ALL);
    let asked = pages.flat_map(|(page, check)| {
        let check_name = page.name();
        let expects_bias = subject.expect_biased && check_name == "mean";
        let questions = check.questions(subject).into_iter();
        questions.map(move |question| Question {
            check: check_name.clone(),
            expects_bias,
            ..question
        })
    });
    asked.collect()
}

/// See [`Check::is_uniform`].
#[must_use]
pub fn is_uniform(name: &str) -> bool {
    let named = CATALOGUE.pages.iter().zip(ALL).find(|(page, _)| page.name() == name);
    named.is_some_and(|(_, check)| check.is_uniform())
}

/// Lists the checks: from one line each come the module, the name and the row in `list`.
macro_rules! checks {
    ($($module:ident :: $Page:ident,)*) => {
        /// Every check, in the order of registration.
        pub const CATALOGUE: Catalogue =
            Catalogue { name: "checks", pages: &[$($crate::page!($module)),*] };

        /// The checks, in the order of the catalogue.
        const ALL: &[&dyn Check] = &[$(&$module::$Page),*];
    };
}

checks! {
    mean::Mean,
    variance::Variance,
    lookups::Lookups,
    covariance::Covariance,
    counts::Counts,
    atoms::Atoms,
    distances::Distances,
    depth::Depth,
    curve::Curve,
    dispersion::Dispersion,
    streams::Streams,
    generator::Generator,
    resolution::Resolution,
    invariant::Invariant,
    numeric::Numeric,
}

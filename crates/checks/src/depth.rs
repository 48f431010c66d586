//! Free-flight distances against their distribution by the Anderson–Darling statistic, which weighs the tails: very
//! near and very far collisions.
//!
//! ```text
//! A² = n ∫ (F_n − F)²/(F(1 − F)) dF,  F = (1 − T(s))/(1 − T(S)) of the rays that collide
//! ```
//!
//! Distances are counted in about a thousand equally probable classes, so that memory does not grow with the draws. The
//! effect on the distribution of A² is negligible.
//!
//! Source: T. W. Anderson, D. A. Darling, *Asymptotic theory of certain "goodness of fit" criteria
//! based on stochastic processes*, Annals of Mathematical Statistics 23 (1952), 193–212.

use super::batch::Batch;
use super::check::{Question, Subject};
use super::distances::{Classes, unrounded};
use super::distribution::DistributionTest;
use super::foreign::{ForeignDraws, ForeignTest};
use crate::CheckKind;
use gate::CheckId;
use gate::stats::anderson_darling;

struct Empirical(Classes);

impl DistributionTest for Empirical {
    fn size(&self) -> usize {
        self.0.len() + 1
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        draws.add_distances(|draws| self.0.count(draws), sums);
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        anderson_darling::p_value_of_classes(&sums[..self.0.len()])
    }
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Depth, questions).of_foreign(of_foreign);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let tails = Classes::of(subject.prediction).map(Empirical);
    Question::distribution(CheckId::Depth, "the tails of the distances", tails)
}

/// Returns the tests of foreign draws.
fn of_foreign(draws: &ForeignDraws) -> Vec<ForeignTest> {
    let what = "the distribution of the distances near both ends";
    let tails = draws.in_full().and_then(Classes::of).map(Empirical);
    ForeignTest::of(what, tails, unrounded(draws))
}

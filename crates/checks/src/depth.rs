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
use super::distances::Classes;
use super::distribution::DistributionTest;
use gate::CheckId;
use gate::stats::anderson_darling;
use theory::Prediction;

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

/// Returns the test; `None` if theory does not know the distribution of the distances.
pub fn of(prediction: &Prediction) -> Option<impl DistributionTest + use<>> {
    Classes::of(prediction).map(Empirical)
}

/// Returns the questions of this check.
pub fn questions(subject: &Subject) -> Vec<Question> {
    Question::distribution(CheckId::Depth, "the tails of the distances", of(subject.prediction))
}

//! The number of lookups against its whole distribution, by Pearson's χ².
//!
//! ```text
//! double:  P(M = m) = Λᵐ e^{−Λ}/m!,  Λ = ∫σ̂
//! single:  P(M = m) = e^{−K(S)} Pois(m; A(S)) + ∫ σ̂(1 − q) e^{−K} Pois(m − 1; A) dt
//! ```
//!
//! It applies where theory knows the distribution and at least two classes expect enough draws.

use super::batch::{Batch, each_value};
use super::check::{Question, Subject};
use super::distribution::DistributionTest;
use super::foreign::{ANY, ForeignDraws, ForeignTest};
use crate::CheckKind;
use gate::CheckId;
use gate::stats::chi_square;
use theory::Prediction;

struct Classes {
    probability: Vec<f64>,
}

impl DistributionTest for Classes {
    fn size(&self) -> usize {
        self.probability.len() + 1
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        let beyond = self.probability.len();
        let count = |lookups: u32, times| sums[(lookups as usize).min(beyond)] += times;
        each_value(draws.lookups.as_ref(), &draws.draws.lookups, count);
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        chi_square::p_value(sums, &self.probability)
    }
}

/// Name of the distribution in sentences.
const WHAT: &str = "the distribution of the lookups";

/// Returns whether theory knows the distribution of the number of lookups.
pub fn is_known(prediction: &Prediction) -> bool {
    classes(prediction).is_some()
}

fn classes(prediction: &Prediction) -> Option<Classes> {
    let density = prediction.lookups.as_ref().filter(|density| density.variance > 0.0)?;
    (!density.pmf.is_empty()).then(|| Classes { probability: density.pmf.clone() })
}

/// The check.
pub const CHECK: CheckKind =
    CheckKind::new(CheckId::Counts, questions).of_biased().of_foreign(of_foreign);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let classes = classes(subject.prediction);
    let bins =
        |density: &Classes| chi_square::testable_bins(&density.probability, subject.fixed as f64);
    Question::distribution(CheckId::Counts, WHAT, classes.filter(|density| bins(density) >= 2))
}

/// Returns the tests of foreign draws.
fn of_foreign(draws: &ForeignDraws) -> Vec<ForeignTest> {
    let classes = classes(draws.prediction).filter(|_| draws.request.has_lookups);
    ForeignTest::of(WHAT, classes, ANY)
}

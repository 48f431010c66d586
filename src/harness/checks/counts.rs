//! The number of lookups against its whole law, by Pearson's χ².
//!
//! ```text
//! double:  P(M = m) = Λᵐ e^{−Λ}/m!,  Λ = ∫σ̂
//! single:  P(M = m) = e^{−K(S)} Pois(m; A(S)) + ∫ σ̂(1 − q) e^{−K} Pois(m − 1; A) dt
//! ```
//!
//! It applies where theory knows the law and at least two classes expect enough draws.

use super::batch::Batch;
use super::question::{Kind, Law, Question, Subject};
use crate::stats::chi_square;

struct Classes {
    probability: Vec<f64>,
}

impl Law for Classes {
    fn size(&self) -> usize {
        self.probability.len() + 1
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        let beyond = self.probability.len();
        let mut count = |lookups: u32, times| sums[(lookups as usize).min(beyond)] += times;
        match &draws.lookups {
            Some(census) => {
                census.values.iter().zip(&census.times).for_each(|(&m, &n)| count(m, n));
            }
            None => draws.draws.lookups.iter().for_each(|&m| count(m, 1.0)),
        }
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        chi_square::p_value(sums, &self.probability)
    }
}

/// What is asked.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let Some(law) = subject.prediction.lookups.as_ref().filter(|law| law.variance > 0.0) else {
        return Vec::new();
    };
    let probability = law.pmf.clone();
    if chi_square::testable_bins(&probability, subject.fixed as f64) < 2 || probability.is_empty() {
        return Vec::new();
    }
    vec![Question::whole("the law of the lookups", Kind::Law(Box::new(Classes { probability })))]
}

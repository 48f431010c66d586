//! The mean number of lookups against theory, by the gate.
//!
//! ```text
//! y = M/E[M] − 1,  Var[y] = Var[M]/E[M]²
//! ```
//!
//! It detects wrong free flights and wrong endings that the mean hides, and much sooner. If the number is constant in
//! theory, every draw must have it. A mean that theory knows roughly is not compared, see [`CountDistribution::is_sharp`].

use super::always::Always;
use super::batch::Observe;
use super::check::{Question, Subject};
use super::scalar::{ScalarCheck, variance};
use crate::CheckKind;
use estimators::DrawBuffer;
use gate::CheckId;
use gate::session::Quantity;
use theory::CountDistribution;

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Lookups, questions).of_biased();

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let distribution =
        subject.prediction.lookups.as_ref().filter(|distribution| distribution.is_sharp());
    let Some(distribution) = distribution else { return Vec::new() };
    let mean = distribution.mean;
    let what = "the number of lookups";
    let question = if distribution.variance > 0.0 {
        let error = CountDistribution::ERROR.max(distribution.error);
        let ground = variance(distribution.variance / (mean * mean), error);
        let lookups = Quantity::lookups(ground, error).within(subject.tolerance.lookups);
        let observe = move |counts: &[u32], y: &mut Vec<f64>| {
            let scale = 1.0 / mean;
            y.extend(counts.iter().map(|&m| f64::from(m) * scale - 1.0));
        };
        let observe = Observe::Lookups(Box::new(observe));
        Question::whole(
            CheckId::Lookups,
            what,
            ScalarCheck::new(subject, lookups.of(mean, mean), observe),
        )
    } else {
        let largest = move |draws: &DrawBuffer| {
            let counts = draws.lookups.iter();
            counts.fold(0.0, |maximum: f64, &m| maximum.max((f64::from(m) - mean).abs()))
        };
        // The predicted number may be rounded; a draw that differs by one is far beyond that.
        Question::whole(
            CheckId::Lookups,
            what,
            Always { is_of_lookups: true, ..Always::new(largest, 0.5) },
        )
    };
    vec![question]
}

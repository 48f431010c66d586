//! The mean number of lookups against theory, by the gate.
//!
//! ```text
//! y = M/E[M] − 1,  Var[y] = Var[M]/E[M]²
//! ```
//!
//! It sees wrong free flights and wrong endings that the mean hides, and much sooner. A number that
//! theory says is always the same must be met by every draw.

use super::observe::Observe;
use super::question::{Always, Kind, Known, Question, Scalar, Subject, Wanted};
use estimators::DrawBuffer;
use theory::CountLaw;

/// The largest relative error of the lookups that is still worth a promise.
const CAP: f64 = 0.02;

/// What is asked.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let Some(law) = &subject.prediction.lookups else { return Vec::new() };
    let mean = law.mean;
    let kind = if law.variance > 0.0 {
        let variance = law.variance / (mean * mean);
        let error = CountLaw::ERROR.max(law.error);
        let known = Known { variance, error, floor: error };
        let wanted = Wanted { tolerance: subject.tolerance.lookups, cap: CAP };
        let observe = move |counts: &[u32], y: &mut Vec<f64>| {
            let scale = 1.0 / mean;
            y.extend(counts.iter().map(|&m| f64::from(m) * scale - 1.0));
        };
        let observe = Observe::Lookups(Box::new(observe));
        Kind::Scalar(Scalar::new(subject, known, wanted, observe).of(mean, mean))
    } else {
        let largest = move |draws: &DrawBuffer| {
            let counts = draws.lookups.iter();
            counts.fold(0.0, |most: f64, &m| most.max((f64::from(m) - mean).abs()))
        };
        // The law's own number may be rounded; a draw that differs by one is far beyond that.
        Kind::Always(Always { largest: Box::new(largest), bound: 0.5 })
    };
    vec![Question::whole("the number of lookups", kind)]
}

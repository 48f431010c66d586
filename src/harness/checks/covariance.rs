//! The covariance of neighbouring distances of one walk against theory, by the gate.
//!
//! ```text
//! y = ((X₁ − T₁)(X₂ − T₂) − C)/(sd₁ sd₂),  C = T₁T₂ expm1(J₂(s₁)),  Var[y] in theory
//! ```
//!
//! It applies to problems with several channels, and is reported with the farther one. Neighbours
//! are enough: increments over disjoint stretches are uncorrelated, so theirs determine the others.

use super::mean::is_faint;
use super::observe::Observe;
use super::question::{Kind, Known, Question, Scalar, Subject, Wanted};
use crate::estimators::DrawBuffer;
use crate::theory::prediction::Covariance as Predicted;

/// The largest error of a covariance, relative to the product of the standard deviations, that is
/// still worth a promise.
const CAP: f64 = 0.2;
/// The same of a prediction.
const ERROR: f64 = 1e-10;

/// What is asked.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let covariances = subject.prediction.covariances.iter();
    covariances
        .filter(|covariance| covariance.pair[0] + 1 == covariance.pair[1])
        .filter_map(|covariance| ask(subject, covariance))
        .collect()
}

fn ask(subject: &Subject, covariance: &Predicted) -> Option<Question> {
    let [first, second] = covariance.pair.map(|i| &subject.prediction.channels[i]);
    if is_faint(subject, first) || is_faint(subject, second) {
        return None;
    }
    let scale = [first, second].map(|channel| {
        let variance = channel.moments.map_or(0.0, |moments| moments.variance());
        1.0 / variance.sqrt()
    });
    let what = format!("the covariance with {}", first.name);
    let unit = scale[0] * scale[1];
    let variance = covariance.variance * unit * unit;
    let kind = if variance.is_finite() && variance > 0.0 {
        let known = Known { variance, error: ERROR, floor: ERROR };
        let wanted = Wanted { tolerance: None, cap: CAP };
        let ([i, j], truth) = (covariance.pair, [first.mean.value, second.mean.value]);
        let expected = covariance.value * unit;
        let observe =
            move |draws: &DrawBuffer, y: &mut Vec<f64>| {
                let both = draws.values[i].iter().zip(&draws.values[j]);
                y.extend(both.map(|(a, b)| {
                    (a - truth[0]) * scale[0] * ((b - truth[1]) * scale[1]) - expected
                }));
            };
        let observe = Observe::Draw(Box::new(observe));
        Kind::Scalar(Scalar::new(subject, known, wanted, observe).of(covariance.value, 1.0 / unit))
    } else {
        Kind::Untestable("its variance overflows".into())
    };
    Some(Question::channel(covariance.pair[1], &what, kind))
}

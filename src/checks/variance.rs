//! The variance of the draws against theory, by the gate.
//!
//! ```text
//! y = (X − E[X])²/V − 1,  Var[y] = κ − 1 in theory
//! ```
//!
//! The predicted mean is known, so nothing is lost to an estimated one, and the exact kurtosis κ
//! makes this a test at its level; normal theory would fail correct estimators of high kurtosis
//! most of the time. Nothing is asked of draws without spread, of draws with two equally distant
//! values, and of experiments that a case declares biased.

use super::mean::is_faint;
use super::observe::Observe;
use super::question::{Kind, Known, Question, Scalar, Subject, Wanted, rounding_of};
use theory::Channel;

/// The largest relative error of the variance that is still worth a promise.
const CAP: f64 = 0.2;
/// A kurtosis this near to 1 makes `(X − E[X])²` constant: nothing is left to test.
const TWO_POINT: f64 = 1.0 + 1e-6;

/// What is asked.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let channels = subject.prediction.channels.iter().enumerate();
    channels
        .filter_map(|(index, channel)| {
            Some(Question::channel(index, "the variance", kind(subject, index, channel)?))
        })
        .collect()
}

fn kind(subject: &Subject, index: usize, channel: &Channel) -> Option<Kind> {
    let moments = channel.moments?;
    let kurtosis = moments.kurtosis().unwrap_or(f64::INFINITY);
    if is_faint(subject, channel) || kurtosis <= TWO_POINT {
        return None;
    }
    let variance = moments.variance();
    if !(kurtosis.is_finite() && variance.is_finite()) {
        return Some(Kind::Untestable(if variance.is_finite() {
            "the fourth moment of a draw is infinite, overflows or is not resolved".into()
        } else {
            "the variance of a draw is infinite or overflows".into()
        }));
    }
    let noise = rounding_of(subject) * channel.truth.value.abs() / variance.sqrt();
    let floor = moments.error + noise * (2.0 + noise);
    // κ = m₄/m₂² is known three times worse than m₂ and m₄, and κ − 1 worse still.
    let error = moments.error * (1.0 + 3.0 * kurtosis / (kurtosis - 1.0));
    let known = Known { variance: kurtosis - 1.0, error, floor };
    let (mean, scale) = (channel.mean.value, 1.0 / variance.sqrt());
    let observe = Observe::each_value(
        index,
        #[inline(always)]
        move |x| {
            let deviation = (x - mean) * scale;
            deviation * deviation - 1.0
        },
    );
    let wanted = Wanted { tolerance: subject.tolerance.variance, cap: CAP };
    let scalar = Scalar::new(subject, known, wanted, observe);
    Some(Kind::Scalar(scalar.of(variance, variance)))
}

//! The variance of the draws against theory, by the gate.
//!
//! ```text
//! y = (X − E[X])²/V − 1,  Var[y] = κ − 1 in theory
//! ```
//!
//! The predicted mean is known, so that no power is lost to an estimated one. The exact kurtosis κ makes this a test at
//! its level; a normal approximation would fail correct estimators of high kurtosis most of the time. No question is
//! asked of draws without spread, of draws with two equally distant values, and of experiments that a case declares
//! biased.

use super::batch::Observe;
use super::check::{Check, Question, Subject, Untestable, rounding_of};
use super::mean::is_faint;
use super::scalar::ScalarCheck;
use crate::CheckKind;
use gate::CheckId;
use gate::session::quantity::{variance_floor, variance_of_squares};
use gate::session::{Quantity, VarianceBound};
use theory::Channel;

/// A kurtosis this close to 1 makes `(X − E[X])²` constant: there is nothing left to test.
const TWO_POINT: f64 = 1.0 + 1e-6;

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Variance, questions);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let channels = subject.prediction.channels.iter().enumerate();
    channels
        .filter_map(|(index, channel)| {
            Some(Question::channel(
                CheckId::Variance,
                index,
                "the variance",
                answer(subject, index, channel)?,
            ))
        })
        .collect()
}

fn answer(subject: &Subject, index: usize, channel: &Channel) -> Option<Box<dyn Check>> {
    let moments = channel.moments?;
    let kurtosis = moments.kurtosis().unwrap_or(f64::INFINITY);
    if is_faint(subject, channel) || kurtosis <= TWO_POINT {
        return None;
    }
    let variance = moments.variance();
    if !(kurtosis.is_finite() && variance.is_finite()) {
        let why = if variance.is_finite() {
            "the fourth moment of a draw is infinite, overflows or is not resolved"
        } else {
            "the variance of a draw is infinite or overflows"
        };
        return Some(Box::new(Untestable(why.to_owned())));
    }
    let rounding = rounding_of(subject) * channel.truth.value.abs();
    let floor = variance_floor(variance, moments.error, rounding);
    let of_squares = VarianceBound::Variance(variance_of_squares(kurtosis, moments.error));
    let (mean, scale) = (channel.mean.value, 1.0 / variance.sqrt());
    let observe = Observe::each_value(
        index,
        #[inline(always)]
        move |x| {
            let deviation = (x - mean) * scale;
            deviation * deviation - 1.0
        },
    );
    let quantity = Quantity::variance(Some(of_squares), floor).within(subject.tolerance.variance);
    Some(Box::new(ScalarCheck::new(subject, quantity.of(variance, variance), observe)))
}

//! Every draw is a finite number.
//!
//! A draw that is NaN or infinite is a failure whatever the other draws are: no mean of such draws exists.

use super::always::Always;
use super::check::{Question, Subject};
use crate::CheckKind;
use estimators::DrawBuffer;
use gate::CheckId;
use numeric::sum::sum_in_lanes;

fn largest(draws: &DrawBuffer) -> f64 {
    // x · 0 is 0 for every finite x and NaN otherwise.
    draws.values.iter().map(|values| sum_in_lanes(values, |x| x * 0.0)).sum()
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Numeric, questions).of_biased();

/// Returns the questions of this check.
fn questions(_: &Subject) -> Vec<Question> {
    vec![Question::whole(CheckId::Numeric, "every draw", Always::new(largest, 0.0))]
}

//! Every draw is a finite number.
//!
//! A draw that is not a number, or infinite, is a failure whatever else the draws say: no mean of
//! such draws exists.

use super::{Always, Ask, Check, Kind, Subject};
use crate::estimators::DrawBuffer;

/// The check of the numbers.
pub struct Numeric;

fn largest(draws: &DrawBuffer) -> f64 {
    // x · 0 is 0 for every finite x and not a number otherwise.
    let zeros = draws.values.iter().flatten().map(|x| x * 0.0);
    zeros.sum::<f64>()
}

impl Check for Numeric {
    fn questions(&self, _: &Subject) -> Vec<Ask> {
        let bound = Always { largest: Box::new(largest), bound: 0.0 };
        vec![Ask::whole("every draw", Kind::Always(bound))]
    }
}

//! A law that holds for every single draw: what a particle still carries and what it handed over
//! is what it began with.
//!
//! ```text
//! X(S) + Σᵢ X(tᵢ⁻)(1 − (1 − rᵢ)/qᵢ) = T_c   to rounding, 16 ε (1 + M) relative to the turnover
//! ```
//!
//! For the double particle (q = 1) without a control it reads Σ rᵢ X(tᵢ⁻) + X(S) = 1: absorbed and
//! transmitted light are all the light there was. It applies to walks that keep their books.

use super::{Always, Ask, Check, Kind, Subject, rounding};
use crate::estimators::DrawBuffer;

/// The check of the invariant.
pub struct Invariant;

fn largest(draws: &DrawBuffer) -> f64 {
    let both = draws.defects.iter().zip(&draws.lookups);
    both.fold(0.0, |most: f64, (defect, &lookups)| {
        let y = defect / (1.0 + f64::from(lookups));
        if y.is_nan() { y } else { most.max(y) }
    })
}

impl Check for Invariant {
    fn questions(&self, subject: &Subject) -> Vec<Ask> {
        if !subject.keeps_books || subject.expect_biased {
            return Vec::new();
        }
        let bound = Always { largest: Box::new(largest), bound: rounding(0.0) };
        vec![Ask::whole("the balance of each walk", Kind::Always(bound))]
    }
}

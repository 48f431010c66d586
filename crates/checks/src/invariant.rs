//! Invariant of every single draw: the weight that a particle still carries and the weight that its collisions took add
//! up to its initial weight.
//!
//! ```text
//! X(S) + Σᵢ X(tᵢ⁻)(1 − (1 − rᵢ)/qᵢ) = T_c   to rounding, 16 ε (1 + M) relative to the sizes of all terms
//! ```
//!
//! For the double particle (q = 1) without a control it reads Σ rᵢ X(tᵢ⁻) + X(S) = 1: absorbed and
//! transmitted light are all the light there was. It applies to walks that measure their own defect.

use super::always::Always;
use super::check::{Question, Subject, rounding};
use crate::CheckKind;
use estimators::DrawBuffer;
use gate::CheckId;

const LANES: usize = 8;

fn largest(draws: &DrawBuffer) -> f64 {
    // Eight at a time: their divisions and comparisons are independent.
    let (mut maximum, mut sum) = ([0.0; LANES], [0.0; LANES]);
    let mut add = |defects: &[f64], lookups: &[u32]| {
        let lanes = maximum.iter_mut().zip(&mut sum);
        for ((&defect, &lookups), (maximum, sum)) in defects.iter().zip(lookups).zip(lanes) {
            let y = defect / (1.0 + f64::from(lookups));
            *maximum = if y > *maximum { y } else { *maximum };
            *sum += y;
        }
    };
    let (defects, last_defects) = draws.defects.as_chunks::<LANES>();
    let (lookups, last_lookups) = draws.lookups.as_chunks::<LANES>();
    for (defects, lookups) in defects.iter().zip(lookups) {
        add(defects, lookups);
    }
    add(last_defects, last_lookups);
    // Defects are not negative: their sum is NaN only if one of them is.
    let sum: f64 = sum.iter().sum();
    if sum.is_nan() { sum } else { maximum.into_iter().fold(0.0, f64::max) }
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Invariant, questions);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    if !subject.has_invariant {
        return Vec::new();
    }
    vec![Question::whole(
        CheckId::Invariant,
        "the balance of each walk",
        Always::new(largest, rounding(0.0)),
    )]
}

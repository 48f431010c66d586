//! The resolution of free-flight distances: no ties, and not all of them single precision.
//!
//! ```text
//! 2¹⁴ distances of 53-bit flights tie with chance 1e-8; of 24-bit ones, 8 times on average
//! ```
//!
//! Coarse random numbers and positions in single precision escape every mean and variance. The
//! check looks at the collisions of one block, drawn once more.

use super::{Ask, Check, Inspected, Kind, Subject};
use crate::harness::plan::BLOCK;
use crate::stats::ties;
use crate::theory::Law;

/// Fewer collisions than this say nothing about their resolution.
const FEWEST: usize = 100;

/// The check of the resolution.
pub struct Resolution;

impl Check for Resolution {
    fn questions(&self, subject: &Subject) -> Vec<Ask> {
        let Some(Law::Distances { end, .. }) = &subject.prediction.law else { return Vec::new() };
        if subject.expect_biased {
            return Vec::new();
        }
        let end = *end;
        let kind = Kind::Inspection(Box::new(move |inspected| p_value(inspected, end)));
        vec![Ask::whole("the resolution of the distances", kind)]
    }

    fn is_uniform(&self) -> bool {
        false
    }
}

fn p_value(inspected: &Inspected, end: f64) -> f64 {
    let mut collisions = inspected.first_draws(BLOCK);
    collisions.retain(|&s| s < end);
    if collisions.len() < FEWEST {
        return 1.0;
    }
    let coarse = ties::all_single_precision(&collisions) || ties::ties(&mut collisions) > 0;
    if coarse { 0.0 } else { 1.0 }
}

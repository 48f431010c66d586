//! The resolution of free-flight distances: no ties, and not all of them single precision.
//!
//! ```text
//! ties among n distances of the law: Poisson of mean  n²/2⁵⁴ + ½ Σ_k n_k² ulp(s_k)/width_k
//! ```
//!
//! over the classes k of the law: the first term is the random number's resolution, 1e-8 for 2¹⁴
//! distances, the second that of a double at the distance `s_k`. Flights of 24 bits tie 8 times on
//! average. Whether all distances are single-precision numbers is asked where they have room to differ.
//!
//! Coarse random numbers and positions in single precision escape every mean and variance. The
//! check looks at the collisions of one block, drawn once more.

use super::question::{Inspected, Kind, Question, Subject};
use crate::harness::addresses::BLOCK;
use crate::stats::ties;
use crate::theory::Law;

/// Fewer collisions than this say nothing about their resolution.
const FEWEST: usize = 100;

/// What is asked.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let Some(Law::Distances { bins, end, from, .. }) = &subject.prediction.law else {
        return Vec::new();
    };
    let (end, grain) = (*end, grain(bins, *end, *from));
    let kind = Kind::Inspection(Box::new(move |inspected| p_value(inspected, end, grain)));
    vec![Question::whole("the resolution of the distances", kind)]
}

/// `Σ_k ulp(s_k)/(width_k K²)` over the K classes: twice the ties of a pair of distances as doubles.
fn grain(bins: &[f64], end: f64, from: f64) -> f64 {
    let inner: Vec<f64> = bins.windows(2).map(|ends| ends[1] - ends[0]).collect();
    // The first class may begin, and the last one end, far from the medium.
    let next = |width: Option<&f64>| width.copied().unwrap_or(end);
    let widths = std::iter::once(next(inner.first()))
        .chain(inner.iter().copied())
        .chain(std::iter::once(next(inner.last())));
    let classes = (bins.len() + 1) as f64;
    let ends = bins.iter().copied().chain(std::iter::once(end));
    let ulp = |s: f64| f64::EPSILON * (from + s).abs().max(s);
    ends.zip(widths).map(|(s, width)| ulp(s) / width).sum::<f64>() / (classes * classes)
}

fn p_value(inspected: &Inspected, end: f64, grain: f64) -> f64 {
    let mut collisions = inspected.first_draws(BLOCK);
    collisions.retain(|&s| s < end);
    if collisions.len() < FEWEST {
        return 1.0;
    }
    let n = collisions.len() as f64;
    let expected = 0.5 * n * n * (2f64.powi(-53) + grain);
    if expected < 1.0 && ties::all_single_precision(&collisions) {
        return 0.0;
    }
    ties::p_value(ties::ties(&mut collisions), expected)
}

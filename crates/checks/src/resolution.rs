//! The resolution of free-flight distances: no ties, and not all of them single precision.
//!
//! ```text
//! ties among n predicted distances: Poisson of mean  n²/2⁵⁴ + ½ Σ_k n_k² ulp(s_k)/width_k
//! ```
//!
//! over the classes k of the distribution: the first term is the random number's resolution, 1e-8 for 2¹⁴ distances,
//! the second that of a double at the distance `s_k`. Flights of 24 bits tie 8 times on average. Another test is
//! whether all distances are single-precision numbers, where they have room to differ.
//!
//! No mean and no variance shows coarse random numbers or positions in single precision. The check looks at the
//! collisions of one block, drawn once more.

use super::check::{Question, Subject};
use super::distribution::{Inspected, Inspection};
use gate::CheckId;
use gate::stats::ties;
use gate::stats::verdict::BLOCK;
use theory::{Distribution, Prediction};

/// Smallest number of collisions that is evidence of their resolution.
pub const MIN_COLLISIONS: usize = 100;

/// Returns the questions of this check.
pub fn questions(subject: &Subject) -> Vec<Question> {
    let Some(resolution) = Resolution::of(subject.prediction) else { return Vec::new() };
    let look = Inspection(move |inspected: &Inspected| p_value(inspected, &resolution));
    vec![Question::whole(CheckId::Resolution, "the resolution of the distances", look)]
}

/// Ties among distances, in theory.
#[derive(Debug, Clone, Copy)]
pub struct Resolution {
    /// Distance of the rays that escape.
    end: f64,
    /// See [`grain`].
    grain: f64,
}

impl Resolution {
    /// Describes the ties of an experiment; `None` if it has no distances.
    pub fn of(prediction: &Prediction) -> Option<Self> {
        let Some(Distribution::Distances { bins, end, from, .. }) = &prediction.distribution else {
            return None;
        };
        Some(Self { end: *end, grain: grain(bins, *end, *from) })
    }

    /// Keeps the distances of the rays that collide.
    pub fn collisions(&self, distances: &mut Vec<f64>) {
        distances.retain(|&s| s < self.end);
    }

    /// Returns the expected number of ties among n distances with random numbers of `bits` bits and positions that are
    /// rounded to `spacing`, relative.
    pub fn expected(&self, n: f64, bits: i32, spacing: f64) -> f64 {
        0.5 * n * n * (2f64.powi(-bits) + self.grain * (spacing / f64::EPSILON))
    }
}

/// Returns `Σ_k ulp(s_k)/(width_k K²)` over the K classes: twice the expected number of ties of a pair of distances as
/// doubles.
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

fn p_value(inspected: &Inspected, resolution: &Resolution) -> f64 {
    let mut collisions = inspected.first_draws(BLOCK);
    resolution.collisions(&mut collisions);
    if collisions.len() < MIN_COLLISIONS {
        return 1.0;
    }
    let expected = resolution.expected(collisions.len() as f64, 53, f64::EPSILON);
    if expected < 1.0 && ties::all_single_precision(&collisions) {
        return 0.0;
    }
    ties::p_value(ties::ties(&mut collisions), expected)
}

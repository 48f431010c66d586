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

use super::batch::Batch;
use super::check::{Question, Subject};
use super::distribution::{DistributionTest, Inspected, Inspection};
use super::foreign::{ANY, ForeignDraws, ForeignTest};
use crate::CheckKind;
use gate::CheckId;
use gate::session::BUFFER;
use gate::stats::ties;
use gate::stats::verdict::BLOCK;
use theory::{Distribution, Prediction};

/// Smallest number of collisions that is evidence of their resolution.
const MIN_COLLISIONS: usize = 100;
/// Spacing of numbers of single precision, relative.
const SINGLE: f64 = 2.4e-7;
/// Coarsest rounding of foreign distances for which their resolution is tested.
const COARSE: f64 = 1e-6;
/// Number of bits of random numbers that counts as fine enough for foreign draws.
const BITS: i32 = 22;
/// Name of the quantity in sentences.
const WHAT: &str = "the resolution of the distances";

/// The check.
pub const CHECK: CheckKind =
    CheckKind::new(CheckId::Resolution, questions).not_uniform().of_foreign(of_foreign);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let Some(resolution) = Resolution::of(subject.prediction) else { return Vec::new() };
    let look = Inspection(move |inspected: &Inspected| p_value(inspected, &resolution));
    vec![Question::whole(CheckId::Resolution, WHAT, look)]
}

/// Returns the tests of foreign draws.
fn of_foreign(draws: &ForeignDraws) -> Vec<ForeignTest> {
    let resolution = draws.in_full().and_then(Resolution::of);
    let resolution = resolution.filter(|_| draws.request.rounding <= COARSE);
    let spacing = if draws.is_single { SINGLE } else { f64::EPSILON };
    let ties = resolution.map(|resolution| ForeignTies { resolution, spacing });
    ForeignTest::of(WHAT, ties, ANY)
}

/// Ties among distances, in theory.
#[derive(Debug, Clone, Copy)]
struct Resolution {
    /// Distance of the rays that escape.
    end: f64,
    /// See [`grain`].
    grain: f64,
}

impl Resolution {
    /// Describes the ties of an experiment; `None` if it has no distances.
    fn of(prediction: &Prediction) -> Option<Self> {
        let Some(Distribution::Distances { bins, end, from, .. }) = &prediction.distribution else {
            return None;
        };
        Some(Self { end: *end, grain: grain(bins, *end, *from) })
    }

    /// Returns the distances of the rays that collide; `None` if they are too few.
    fn collisions(&self, distances: &[f64]) -> Option<Vec<f64>> {
        let collisions = distances.iter().copied().filter(|&s| s < self.end);
        let collisions: Vec<f64> = collisions.collect();
        (collisions.len() >= MIN_COLLISIONS).then_some(collisions)
    }

    /// Returns the expected number of ties among n distances with random numbers of `bits` bits and positions that are
    /// rounded to `spacing`, relative.
    fn expected(&self, n: f64, bits: i32, spacing: f64) -> f64 {
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
    let collisions = resolution.collisions(&inspected.first_draws(BLOCK));
    let Some(mut collisions) = collisions else { return 1.0 };
    let expected = resolution.expected(collisions.len() as f64, 53, f64::EPSILON);
    if expected < 1.0 && ties::all_single_precision(&collisions) {
        return 0.0;
    }
    ties::p_value(ties::ties(&mut collisions), expected)
}

/// Ties among the first foreign flights: too many mean that distances are rounded more than to single precision. The sums
/// are the number of flights so far, and then the flights.
struct ForeignTies {
    resolution: Resolution,
    /// Relative spacing of the flights.
    spacing: f64,
}

impl ForeignTies {
    /// Returns the numbers of ties, of expected ties and of collisions; `None` for too few collisions.
    fn count(&self, sums: &[f64]) -> Option<(usize, f64, usize)> {
        let (taken, first) = sums.split_first()?;
        let mut collisions = self.resolution.collisions(&first[..count(*taken)])?;
        let all = collisions.len();
        let expected = self.resolution.expected(all as f64, BITS, self.spacing);
        Some((ties::ties(&mut collisions), expected, all))
    }
}

impl DistributionTest for ForeignTies {
    fn size(&self) -> usize {
        BUFFER + 1
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        let Some((taken, first)) = sums.split_first_mut() else { return };
        for (place, &s) in first[count(*taken)..].iter_mut().zip(&draws.draws.values[0]) {
            *place = s;
            *taken += 1.0;
        }
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        self.count(sums).map(|(finding, expected, _)| ties::p_value(finding, expected))
    }

    fn details(&self, sums: &[f64], _: f64) -> String {
        let Some((finding, expected, all)) = self.count(sums) else { return String::new() };
        format!(
            "{finding} of {all} flights have the length of an earlier one, {expected:.0} at most are expected of single \
             precision"
        )
    }
}

/// Converts a sum of ones.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most the length of a block
fn count(sum: f64) -> usize {
    sum as usize
}

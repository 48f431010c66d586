//! Draws at the same place of different blocks: their sums across the blocks.
//!
//! ```text
//! S_i = Σ_b z_{b,i},  z = (X − E[X])/√V;   Σ_i S_i²/B has mean L and variance L(2 + (κ − 3)/B)
//! ```
//!
//! The sum over blocks needs two conditions: `(κ − 3)/B ≤ 1/2`, and `E[z⁸] ≤ 0.06 L B³`, so that no single draw of a
//! heavy tail decides.
//!
//! Sums over B blocks that share a seed have B times the variance, twice it for two blocks. The test uses the first L =
//! 1024 draws of each block.

use super::batch::Batch;
use super::check::{Question, Subject, last_channel};
use super::distribution::DistributionTest;
use crate::CheckKind;
use gate::CheckId;
use gate::stats::correlation;
use gate::stats::verdict::BLOCK;

/// L.
const FIRST: usize = 1024;
/// Smallest number of blocks for a test.
const MIN_BLOCKS: u64 = 4;
/// Largest `(κ − 3)/B` for which the sums are nearly normal.
const MAX_EXCESS: f64 = 0.5;
/// Largest `E[z⁸]/(6 L B³)`: beyond it, a single draw may decide.
const MAX_BY_ONE: f64 = 0.01;

struct IndexSums {
    mean: f64,
    scale: f64,
    kurtosis: f64,
}

impl DistributionTest for IndexSums {
    fn size(&self) -> usize {
        FIRST + 1
    }

    fn add(&self, draws: &Batch, first: usize, sums: &mut [f64]) {
        let Some(values) = draws.draws.values.last() else { return };
        let places = sums[..FIRST].iter_mut().skip(first);
        for (sum, x) in places.zip(values) {
            *sum += (x - self.mean) * self.scale;
        }
    }

    fn close(&self, draws: usize, sums: &mut [f64]) {
        // A last block that does not reach all places is left out.
        if draws < FIRST {
            sums.fill(0.0);
        } else {
            sums[FIRST] = 1.0;
        }
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of blocks
        let blocks = sums[FIRST] as usize;
        correlation::index_sums(&sums[..FIRST], blocks, self.kurtosis - 3.0)
    }
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Streams, questions);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let Some((channel, moments)) = last_channel(subject) else { return Vec::new() };
    let kurtosis = moments.kurtosis().unwrap_or(f64::INFINITY);
    let blocks = subject.fixed / BLOCK;
    let enough = blocks >= MIN_BLOCKS && (kurtosis - 3.0) <= MAX_EXCESS * blocks as f64;
    let eighth = channel.tails.eighth_moment_ratio * kurtosis * kurtosis;
    let by_one = eighth / (6.0 * FIRST as f64 * (blocks as f64).powi(3));
    let enough = enough && by_one <= MAX_BY_ONE;
    let (mean, scale) = (channel.mean.value, 1.0 / moments.variance().sqrt());
    let sums = IndexSums { mean, scale, kurtosis };
    Question::distribution(CheckId::Streams, "the sums across streams", enough.then_some(sums))
}

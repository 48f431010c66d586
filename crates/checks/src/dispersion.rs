//! The spread of the blocks' means: neither too large nor too small.
//!
//! ```text
//! z_b = Σ (X − E[X])/√(n_b V),  Σ_b z_b² is χ² with as many degrees of freedom as blocks
//! ```
//!
//! Blocks have streams of their own. Streams that repeat each other make blocks agree too well; streams that depend on
//! each other make them differ too much. Neither need show in the mean of the run. The χ² distribution holds for blocks
//! of at least 100 κ draws and ten times the rare-event size.

use super::batch::Batch;
use super::check::{Question, Subject, last_channel};
use super::distribution::DistributionTest;
use crate::{CheckKind, normality};
use gate::CheckId;
use gate::stats::chi_square;
use gate::stats::verdict::BLOCK;
use numeric::sum::sum_in_lanes;

/// Smallest number of blocks for a test.
const MIN_BLOCKS: u64 = 4;

struct BlockMeans {
    mean: f64,
    scale: f64,
    /// Smallest number of draws for which the mean of a block is nearly normal.
    minimum: f64,
}

impl DistributionTest for BlockMeans {
    fn size(&self) -> usize {
        2
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        let y = |x: f64| (x - self.mean) * self.scale;
        sums[0] += match (draws.values.last(), draws.draws.values.last()) {
            (Some(Some(census)), _) => census.sum(|&x| y(x)),
            (_, Some(values)) => sum_in_lanes(values, y),
            (_, None) => 0.0,
        };
    }

    fn close(&self, draws: usize, sums: &mut [f64]) {
        if draws as f64 >= self.minimum {
            sums[0] = sums[0] * sums[0] / draws as f64;
            sums[1] = 1.0;
        } else {
            sums.fill(0.0);
        }
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        (sums[1] > 0.0).then(|| chi_square::two_sided(sums[0], sums[1]))
    }
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Dispersion, questions);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let Some((channel, moments)) = last_channel(subject) else { return Vec::new() };
    let kurtosis = moments.kurtosis().unwrap_or(f64::INFINITY);
    let needed = normality::needed(kurtosis, channel.tails.rare_event_size);
    let enough = BLOCK as f64 >= needed && subject.fixed / BLOCK >= MIN_BLOCKS;
    let (mean, scale) = (channel.mean.value, 1.0 / moments.variance().sqrt());
    let means = BlockMeans { mean, scale, minimum: needed };
    Question::distribution(
        CheckId::Dispersion,
        "the spread of the blocks' means",
        enough.then_some(means),
    )
}

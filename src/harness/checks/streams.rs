//! Draws at the same place of different blocks: their sums across the blocks.
//!
//! ```text
//! S_i = Σ_b z_{b,i},  z = (X − E[X])/√V;   Σ_i S_i²/B has mean L and variance L(2 + (κ − 3)/B)
//! ```
//!
//! B blocks that share a seed have sums B times as wide; two that share one, twice. It looks at the
//! first L = 1024 draws of each block.

use super::mean::is_certain;
use super::{Ask, Check, Kind, Law, Subject};
use crate::estimators::DrawBuffer;
use crate::harness::plan::BLOCK;
use crate::stats::correlation;

/// L.
const FIRST: usize = 1024;
/// The fewest blocks that make a test.
const FEWEST: u64 = 4;
/// The largest `(κ − 3)/B` for which the sums are near normal.
const MOST_EXCESS: f64 = 0.5;

/// The check of the streams.
pub struct Streams;

struct IndexSums {
    mean: f64,
    scale: f64,
    kurtosis: f64,
}

impl Law for IndexSums {
    fn size(&self) -> usize {
        FIRST + 1
    }

    fn add(&self, draws: &DrawBuffer, first: usize, sums: &mut [f64]) {
        let Some(values) = draws.values.last() else { return };
        let places = sums[..FIRST].iter_mut().skip(first);
        for (sum, x) in places.zip(values) {
            *sum += (x - self.mean) * self.scale;
        }
    }

    fn close(&self, _: usize, sums: &mut [f64]) {
        sums[FIRST] = 1.0;
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of blocks
        let blocks = sums[FIRST] as usize;
        correlation::index_sums(&sums[..FIRST], blocks, self.kurtosis - 3.0)
    }
}

impl Check for Streams {
    fn questions(&self, subject: &Subject) -> Vec<Ask> {
        let Some(channel) = subject.prediction.channels.last() else { return Vec::new() };
        let Some(moments) = channel.moments else { return Vec::new() };
        let kurtosis = moments.kurtosis().unwrap_or(f64::INFINITY);
        let blocks = subject.fixed / BLOCK;
        let enough = blocks >= FEWEST && (kurtosis - 3.0) <= MOST_EXCESS * blocks as f64;
        if subject.expect_biased || is_certain(subject, channel) || !enough {
            return Vec::new();
        }
        let (mean, scale) = (channel.mean.value, 1.0 / moments.variance().sqrt());
        let law = IndexSums { mean, scale, kurtosis };
        vec![Ask::whole("the sums across streams", Kind::Law(Box::new(law)))]
    }
}

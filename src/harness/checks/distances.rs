//! Free-flight distances against their law: twenty equally probable bins and the atom of the rays
//! that escape, by Pearson's χ².
//!
//! ```text
//! P(s ≤ t) = 1 − T(t),  P(s = S) = T(S)
//! ```

use super::{Ask, Check, Kind, Law, Subject};
use crate::estimators::DrawBuffer;
use crate::harness::counted::Counted;
use crate::stats::chi_square;
use crate::theory;

/// The number of bins.
const BINS: usize = 20;

/// The check of the distances.
pub struct Distances;

/// Equally probable classes of the distances of the rays that collide.
pub struct Classes {
    /// The upper ends of all classes but the last.
    ends: Vec<f64>,
    /// The distance of the rays that escape.
    escape: f64,
    /// The probability of that.
    escapes: f64,
}

impl Classes {
    /// `wanted` classes, or as many as theory has where that is less.
    #[must_use]
    pub fn of(subject: &Subject, wanted: usize) -> Option<Self> {
        let Some(theory::Law::Distances { bins, end, escape, .. }) = &subject.prediction.law else {
            return None;
        };
        let step = (bins.len() + 1) / wanted.min(bins.len() + 1);
        let ends = bins.iter().skip(step - 1).step_by(step).copied().collect();
        Some(Self { ends, escape: *end, escapes: *escape })
    }

    /// How many classes, escape not counted.
    pub(super) fn len(&self) -> usize {
        self.ends.len() + 1
    }

    /// Counts draws: the classes in order, then the rays that escape.
    pub fn count(&self, draws: &DrawBuffer, sums: &mut [f64]) {
        for &s in &draws.values[0] {
            let class = if s >= self.escape {
                self.len()
            } else {
                self.ends.partition_point(|&end| end <= s)
            };
            sums[class] += 1.0;
        }
    }
}

impl Law for Classes {
    fn size(&self) -> usize {
        self.len() + 1
    }

    fn add(&self, draws: &Counted, _: usize, sums: &mut [f64]) {
        self.count(draws.draws, sums);
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        let mut probability = vec![(1.0 - self.escapes) / self.len() as f64; self.len()];
        probability.push(self.escapes);
        chi_square::p_value(sums, &probability)
    }
}

impl Check for Distances {
    fn questions(&self, subject: &Subject) -> Vec<Ask> {
        let classes = Classes::of(subject, BINS).filter(|_| !subject.expect_biased);
        let kind = classes.map(|classes| Kind::Law(Box::new(classes)));
        kind.map(|kind| Ask::whole("the law of the distances", kind)).into_iter().collect()
    }
}

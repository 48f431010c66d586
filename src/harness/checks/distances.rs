//! Free-flight distances against their law: twenty equally probable bins and the atom of the rays
//! that escape, by Pearson's χ².
//!
//! ```text
//! P(s ≤ t) = 1 − T(t),  P(s = S) = T(S)
//! ```

use super::{Ask, Check, Kind, Law, Subject};
use crate::estimators::DrawBuffer;
use crate::harness::counted::Counted;
use crate::numeric::pack::in_fused_code;
use crate::stats::chi_square;
use crate::theory;

/// The number of bins.
const BINS: usize = 20;

/// Cells of the guide per class.
const CELLS: usize = 8;
/// The share of a cell by which rounding surely moves no distance.
const SLACK: f64 = 0.0625;
/// From here on doubles are whole numbers.
const INTEGERS: f64 = 4_503_599_627_370_496.0;
/// Distances that are counted at once.
const ROW: usize = 512;
/// Ends that a distance is compared with at once.
const NEAR: usize = 3;
/// So few ends need no guide.
const FEW: usize = 32;

/// The check of the distances.
pub struct Distances;

/// Equally probable classes of the distances of the rays that collide.
pub struct Classes {
    /// The upper ends of all classes, the last of which is the distance of the rays that escape, and
    /// [`NEAR`] that are no number: nothing reaches those.
    ends: Vec<f64>,
    /// How many classes.
    total: usize,
    /// Equal cells from the first end to the last but one: how many ends surely lie before each.
    guide: Vec<u16>,
    /// Where the cells begin.
    first: f64,
    /// The number of the last cell.
    last: f64,
    /// How many there are in a length of 1.
    scale: f64,
    /// The probability that a ray escapes.
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
        let ends: Vec<f64> = bins.iter().skip(step - 1).step_by(step).copied().collect();
        Some(Self::new(ends, *end, *escape))
    }

    /// Of the ends of all classes but the last.
    fn new(mut ends: Vec<f64>, escape: f64, escapes: f64) -> Self {
        let first = ends.first().copied().unwrap_or_default();
        let length = ends.last().map_or(0.0, |last| last - first);
        let cells = CELLS * ends.len();
        let width = length / cells.max(1) as f64;
        ends.push(escape);
        let total = ends.len();
        // A distance that rounding puts into the next cell still finds its class ahead.
        let before = |cell: usize| first + width * (cell as f64 - 1.0 - SLACK);
        let passed = |cell| ends.partition_point(|&end| end < before(cell));
        // Fewer than there are is a guide, too.
        let guide = (0..=cells + 1).map(|cell| u16::try_from(passed(cell)).unwrap_or(u16::MAX));
        let scale = if width > 0.0 { 1.0 / width } else { 0.0 };
        let (guide, last) = (guide.collect(), (cells + 1) as f64);
        ends.extend([f64::NAN; NEAR]);
        Self { ends, total, guide, first, last, scale, escapes }
    }

    /// The cell of a distance.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // the last bits of 2^52 and a little more
    fn cell(&self, s: f64) -> u32 {
        // The nearest integer of half a cell less: a conversion that need not guard against overflow.
        let cell = (s - self.first) * self.scale + 0.5;
        // One instruction each, unlike `max` and `min`; what is no number comes to lie in the first cell.
        let cell = if cell > 0.0 { cell } else { 0.0 };
        let cell = if cell < self.last { cell } else { self.last };
        (cell + INTEGERS).to_bits() as u32
    }

    /// The class of a distance in a cell, that of the rays that escape last: how many ends are not beyond
    /// it.
    #[inline(always)]
    fn class(&self, s: f64, cell: u32) -> usize {
        let mut class = self.guide.get(cell as usize).map_or(0, |&before| usize::from(before));
        loop {
            let near = self.ends.get(class..).and_then(<[f64]>::first_chunk::<NEAR>);
            let Some(near) = near else { return class };
            // Most cells lie in one class or two, and escape is one more: sums do not hang on chance, as
            // branches would.
            let reached = near.iter().map(|&end| usize::from(end <= s)).sum::<usize>();
            class += reached;
            if reached < NEAR {
                return class;
            }
        }
    }

    /// How many classes, escape not counted.
    pub(super) fn len(&self) -> usize {
        self.total
    }

    /// Counts draws: the classes in order, then the rays that escape.
    pub fn count(&self, draws: &DrawBuffer, sums: &mut [f64]) {
        let values = &draws.values[0];
        if self.total <= FEW {
            // All draws of a row against one end after the other, so that no branch hangs on chance.
            for values in values.chunks(ROW) {
                let mut reached = values.len();
                for (sum, &end) in sums.iter_mut().zip(&self.ends[..self.total]) {
                    let beyond = in_fused_code(
                        #[inline(always)]
                        || values.iter().map(|&s| usize::from(s >= end)).sum::<usize>(),
                    );
                    *sum += (reached - beyond) as f64;
                    reached = beyond;
                }
                sums[self.total] += reached as f64;
            }
            return;
        }
        // The cells of a row at once: that has no branches and no lists.
        let mut cells = [0; ROW];
        for values in values.chunks(ROW) {
            in_fused_code(
                #[inline(always)]
                || cells.iter_mut().zip(values).for_each(|(cell, &s)| *cell = self.cell(s)),
            );
            for (&s, &cell) in values.iter().zip(&cells) {
                sums[self.class(s, cell)] += 1.0;
            }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_classes_and_many_count_alike() {
        let mut draws = DrawBuffer::new(1);
        draws.values[0] = (0..4096).map(|i| f64::from(i * i % 1009) * 0.005).collect();
        let ends: Vec<f64> = (1..64).map(|i| 0.05 * f64::from(i)).collect();
        let few: Vec<f64> = ends.iter().skip(1).step_by(2).copied().collect();
        let (fine, coarse) = (Classes::new(ends, 4.5, 0.1), Classes::new(few, 4.5, 0.1));
        let (mut many, mut few) = (vec![0.0; 65], vec![0.0; 33]);
        fine.count(&draws, &mut many);
        coarse.count(&draws, &mut few);
        assert_eq!(few.iter().sum::<f64>(), 4096.0);
        assert_eq!(few[32], many[64]);
        for (class, count) in few[..32].iter().enumerate() {
            assert_eq!(*count, many[2 * class] + many[2 * class + 1], "class {class}");
        }
    }

    #[test]
    fn the_guide_finds_the_class_that_a_search_finds() {
        let cubes: Vec<f64> = (1..200).map(|i| 3.0 + (0.01 * f64::from(i)).powi(3)).collect();
        let even: Vec<f64> = (1..20).map(|i| 0.1 * f64::from(i)).collect();
        for ends in [cubes, even, vec![4.0], vec![1.0, 1.0 + f64::EPSILON], Vec::new()] {
            let classes = Classes::new(ends.clone(), 20.0, 0.1);
            let near = ends.iter().flat_map(|&end| [end, end.next_down(), end.next_up()]);
            let far = (0..4000).map(|i| 0.003 * f64::from(i) - 1.0);
            for s in near.chain(far) {
                let expected = ends.partition_point(|&end| end <= s);
                assert_eq!(
                    classes.class(s, classes.cell(s)),
                    expected,
                    "{s} in {} classes",
                    ends.len()
                );
            }
        }
    }
}

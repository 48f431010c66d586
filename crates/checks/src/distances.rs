//! Free-flight distances against their distribution: twenty equally probable bins and the atom of the rays that escape,
//! by Pearson's χ².
//!
//! ```text
//! P(s ≤ t) = 1 − T(t),  P(s = S) = T(S)
//! ```
//!
//! Distances are counted once, in the thousand classes of [`super::depth`]; bins are made of those.

use super::batch::Batch;
use super::check::{Question, Subject};
use super::distribution::DistributionTest;
use super::foreign::{ANY, ForeignDraws, ForeignTest};
use crate::CheckKind;
use ::theory::{self, Prediction};
use estimators::DrawBuffer;
use gate::CheckId;
use gate::stats::chi_square;
use numeric::digits::short;
use numeric::fused::in_fused_code;

/// Number of bins.
const BINS: usize = 20;

/// Number of cells of the guide per class.
const CELLS: usize = 8;
/// Share of a cell that rounding of a distance certainly does not exceed.
const SLACK: f64 = 0.0625;
/// From this value on all doubles are whole numbers: 2⁵².
const INTEGERS: f64 = 4_503_599_627_370_496.0;
/// Number of distances that are counted at once.
const ROW: usize = 512;
/// Number of ends that a distance is compared with at once.
const NEAR: usize = 2;
/// Number of copies of the counts: one increment need not wait until the last is stored.
const FOLD: usize = 2;

/// Equally probable classes of the distances of the rays that collide.
pub struct Classes {
    /// Upper ends of all classes, the last of which is the distance of the rays that escape, and [`NEAR`] NaNs behind
    /// them, which compare false with every distance.
    ends: Vec<f64>,
    /// Number of classes.
    total: usize,
    /// Number of ends that certainly lie before each cell: equal cells from the first end to the last but one, one
    /// before and one behind them.
    guide: Vec<u16>,
    /// Distance at which the cells begin.
    first: f64,
    /// Number of the last cell.
    last: f64,
    /// Number of cells per unit of length.
    scale: f64,
    /// Probability that a ray escapes.
    escapes: f64,
}

impl Classes {
    /// Returns the classes of the predicted distribution.
    pub fn of(prediction: &Prediction) -> Option<Self> {
        let Some(theory::Distribution::Distances { bins, end, escape, .. }) =
            &prediction.distribution
        else {
            return None;
        };
        Some(Self::new(bins.clone(), *end, *escape))
    }

    /// Makes classes from the ends of all of them but the last.
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
        // The guide may be too small, never too large. Distances farther by a cell get the class of escape: rays that
        // escape are frequent and irregular, which would make a branch unpredictable.
        let guide = (0..=cells + 2).map(|cell| u16::try_from(passed(cell)).unwrap_or(u16::MAX));
        let scale = if width > 0.0 { 1.0 / width } else { 0.0 };
        let (guide, last) = (guide.collect(), (cells + 2) as f64);
        ends.extend([f64::NAN; NEAR]);
        Self { ends, total, guide, first, last, scale, escapes }
    }

    /// Returns the cell of a distance.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // the last bits of 2^52 and a little more
    fn cell(&self, s: f64) -> u32 {
        // Rounds half a cell less to the nearest integer: this conversion needs no guard against overflow.
        let cell = (s - self.first) * self.scale + 0.5;
        // One instruction each, unlike `max` and `min`; NaN goes to the first cell.
        let cell = if cell > 0.0 { cell } else { 0.0 };
        let cell = if cell < self.last { cell } else { self.last };
        (cell + INTEGERS).to_bits() as u32
    }

    /// Returns the class of a distance in a cell, the class of the rays that escape last: the number of ends that are
    /// not beyond it.
    #[inline(always)]
    fn class(&self, s: f64, cell: u32) -> usize {
        let mut class = self.guide.get(cell as usize).map_or(0, |&before| usize::from(before));
        loop {
            let near = self.ends.get(class..).and_then(<[f64]>::first_chunk::<NEAR>);
            let Some(near) = near else { return class };
            // Most cells lie in one class or two, and escape is one more. Sums take the same time for all distances;
            // branches would be mispredicted.
            let reached = near.iter().map(|&end| usize::from(end <= s)).sum::<usize>();
            class += reached;
            if reached < NEAR {
                return class;
            }
        }
    }

    /// Returns the number of classes, escape not counted.
    pub(super) fn len(&self) -> usize {
        self.total
    }

    /// Returns the number of draws in each class, in order, and of the rays that escape.
    pub fn count(&self, draws: &DrawBuffer) -> Vec<f64> {
        let mut counts = vec![[0_u32; FOLD]; self.total + 1];
        // All cells of a row at once, without branches and lists.
        let mut cells = [0; ROW];
        for values in draws.values[0].chunks(ROW) {
            in_fused_code(
                #[inline(always)]
                || cells.iter_mut().zip(values).for_each(|(cell, &s)| *cell = self.cell(s)),
            );
            for (fold, (&s, &cell)) in values.iter().zip(&cells).enumerate() {
                counts[self.class(s, cell)][fold % FOLD] += 1;
            }
        }
        counts.into_iter().map(|counts| f64::from(counts.iter().sum::<u32>())).collect()
    }
}

/// Bins of `size` classes.
struct Bins {
    classes: Classes,
    size: usize,
}

impl DistributionTest for Bins {
    fn size(&self) -> usize {
        self.classes.len() + 1
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        draws.add_distances(|draws| self.classes.count(draws), sums);
    }

    fn p_value(&self, sums: &[f64], _: f64) -> Option<f64> {
        let (sums, escaped) = sums.split_at(self.classes.len());
        let share = (1.0 - self.classes.escapes) / self.classes.len() as f64;
        let bins = sums.chunks(self.size);
        let mut counts: Vec<f64> = bins.clone().map(|bin| bin.iter().sum()).collect();
        let mut probability: Vec<f64> = bins.map(|bin| share * bin.len() as f64).collect();
        counts.extend(escaped);
        probability.push(self.classes.escapes);
        chi_square::p_value(&counts, &probability)
    }

    fn details(&self, sums: &[f64], draws: f64) -> String {
        let escaped = sums.last().copied().unwrap_or_default();
        let expected = self.classes.escapes * draws;
        // Otherwise the share is right, or too few draws decide about it.
        if (escaped - expected).abs() <= 5.0 * expected.max(1.0).sqrt() {
            return String::new();
        }
        let percent = |count: f64| short(100.0 * count / draws, 3);
        format!("{} % of the flights leave, {} % expected", percent(escaped), percent(expected))
    }
}

impl Bins {
    /// Returns the bins of the predicted distribution.
    fn of(prediction: &Prediction) -> Option<Self> {
        let classes = Classes::of(prediction)?;
        let size = (classes.len() / BINS).max(1);
        Some(Self { classes, size })
    }
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Distances, questions).of_foreign(of_foreign);

/// Name of the distribution in sentences.
const WHAT: &str = "the distribution of the distances";

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    Question::distribution(CheckId::Distances, WHAT, Bins::of(subject.prediction))
}

/// Returns the tests of foreign draws.
fn of_foreign(draws: &ForeignDraws) -> Vec<ForeignTest> {
    ForeignTest::of(WHAT, draws.in_full().and_then(Bins::of), unrounded(draws))
}

/// Largest shift of a class's share by rounding, in standard errors.
const HARMLESS: f64 = 0.05;

/// Returns the numbers of foreign draws for which rounding moves no end of a class by more than a twentieth of its
/// standard error.
pub(super) fn unrounded(draws: &ForeignDraws) -> [f64; 2] {
    let Some(theory::Distribution::Distances { bins, from, .. }) = &draws.prediction.distribution
    else {
        return ANY;
    };
    let (classes, rounding) = ((bins.len() + 1) as f64, draws.error_of_position());
    let width = |k: usize| bins.get(k + 1).map_or(f64::INFINITY, |next| next - bins[k]);
    let maximum = |k: usize| {
        let below = (k + 1) as f64 / classes;
        let narrow = width(k).min(k.checked_sub(1).map_or(f64::INFINITY, width));
        let moved = rounding * (from.abs() + bins[k]) / (narrow * classes);
        HARMLESS * HARMLESS * below * (1.0 - below) / (moved * moved)
    };
    [0.0, (0..bins.len()).map(maximum).fold(f64::INFINITY, f64::min)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_draw_is_counted_in_its_class() {
        let mut draws = DrawBuffer::new(1);
        draws.values[0] = (0..4096).map(|i| f64::from(i * i % 1009) * 0.005).collect();
        let ends: Vec<f64> = (1..64).map(|i| 0.05 * f64::from(i)).collect();
        let classes = Classes::new(ends.clone(), 4.5, 0.1);
        let mut expected = vec![0.0; 65];
        for s in &draws.values[0] {
            expected[ends.iter().chain(&[4.5]).filter(|&end| end <= s).count()] += 1.0;
        }
        assert_eq!(classes.count(&draws), expected);
    }

    #[test]
    fn bins_are_made_of_classes() {
        let classes = Classes::new((1..64).map(f64::from).collect(), 64.0, 0.36);
        let bins = Bins { size: classes.len() / 16, classes };
        let mut sums = vec![1000.0; 65];
        sums[64] = 36_000.0;
        let p = |sums: &[f64]| bins.p_value(sums, 1e5);
        assert!(p(&sums).is_some_and(|p| p > 0.999), "{:?}", p(&sums));
        // A shift within a bin is not detected, one into another bin is.
        (sums[4], sums[7]) = (0.0, 2000.0);
        assert!(p(&sums).is_some_and(|p| p > 0.999));
        (sums[8], sums[7]) = (3000.0, 0.0);
        assert!(p(&sums).is_some_and(|p| p < 1e-9));
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

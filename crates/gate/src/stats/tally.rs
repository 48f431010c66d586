//! Sums of draws, block by block, and a census of draws that take few values.
//!
//! A sum over a census costs as much as there are values, not as there are draws.

use numeric::fused::in_fused_code;
use numeric::sum::Sum;

/// Number of sums side by side.
const LANES: usize = 16;

/// Sums of `y` and `y²`, where `y` is a draw less a known shift, in units of a known scale.
///
/// The shift is the predicted mean, so that a small variance on a large mean loses no digits. Within a block the
/// sums are plain. Blocks are merged in the order of their addresses with compensated sums, so that the result does
/// not depend on the thread that drew a block.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tally {
    /// Number of draws.
    pub draws: u64,
    sum: Sum,
    squares: Sum,
    /// Draws that were not finite numbers.
    pub not_finite: u64,
}

/// Mean and unbiased variance of the `y`s of a tally.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments2 {
    /// `ȳ`.
    pub mean: f64,
    /// `s²`, with `n − 1` in the denominator; `None` below two draws.
    pub variance: Option<f64>,
}

impl Tally {
    /// The sums of one block, or a part of it.
    pub fn of(values: &[f64], shift: f64, scale: f64) -> Self {
        let inverse = 1.0 / scale;
        let y = |value: f64| (value - shift) * inverse;
        let (rows, rest) = values.as_chunks::<LANES>();
        // Many sums of each, with independent additions. They belong to the loop, which keeps them in registers.
        let [mut sums, mut squares] = in_fused_code(
            #[inline(always)]
            || {
                let (mut sums, mut squares) = ([0.0; LANES], [0.0; LANES]);
                for row in rows {
                    for lane in 0..LANES {
                        let y = y(row[lane]);
                        sums[lane] += y;
                        squares[lane] += y * y;
                    }
                }
                [sums, squares]
            },
        );
        for ((sum, square), &value) in sums.iter_mut().zip(&mut squares).zip(rest) {
            let y = y(value);
            *sum += y;
            *square += y * y;
        }
        let squares: f64 = squares.iter().sum();
        let mut tally = Self { draws: values.len() as u64, ..Self::default() };
        tally.sum.add(sums.iter().sum());
        tally.squares.add(squares);
        if !squares.is_finite() {
            tally.not_finite = values.iter().filter(|x| !x.is_finite()).count() as u64;
        }
        tally
    }

    /// The sums of values with their numbers of occurrences.
    pub fn counted<T: Copy + Into<f64>>(census: &Census<T>, shift: f64, scale: f64) -> Self {
        let mut tally = Self::default();
        for (&value, &times) in census.values.iter().zip(&census.times) {
            let y = (value.into() - shift) / scale;
            tally.sum.add(times * y);
            tally.squares.add(times * y * y);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
            let draws = times as u64;
            tally.draws += draws;
            tally.not_finite += if value.into().is_finite() { 0 } else { draws };
        }
        tally
    }

    /// Adds the sums of the following block.
    pub fn merge(&mut self, later: &Self) {
        self.draws += later.draws;
        self.not_finite += later.not_finite;
        self.sum.merge(&later.sum);
        self.squares.merge(&later.squares);
    }

    /// `mean of y²`: the variance about the shift; `None` without draws.
    pub fn mean_square(&self) -> Option<f64> {
        (self.draws > 0).then(|| self.squares.value() / self.draws as f64)
    }

    /// Mean and variance of the `y`s; `None` without draws.
    pub fn moments(&self) -> Option<Moments2> {
        let n = self.draws as f64;
        if self.draws == 0 {
            return None;
        }
        let mean = self.sum.value() / n;
        let scatter = self.squares.value() - n * mean * mean;
        let variance = (self.draws > 1).then(|| scatter.max(0.0) / (n - 1.0));
        Some(Moments2 { mean, variance })
    }
}

/// Size of the table of values: twice the maximum number of values, so that few collide.
const PLACES: usize = 128;
/// Maximum number of different values.
const MAX_FILLED: usize = PLACES / 2;
/// Number of copies of each count, so that an addition does not depend on the store of the last one.
const FOLD: usize = 4;
/// Largest integer that is counted in a table.
const LARGEST: usize = 1023;
/// Minimum number of draws per value at which counting saves time.
const WORTH: usize = 8;

/// Values with their numbers of occurrences.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Census<T> {
    /// The values, each different from the others, in arbitrary order.
    pub values: Vec<T>,
    /// Numbers of occurrences: integers above 0.
    pub times: Vec<f64>,
}

impl<T> Census<T> {
    /// `Σ f(value)` over all draws.
    pub fn sum(&self, f: impl Fn(&T) -> f64) -> f64 {
        self.values.iter().zip(&self.times).map(|(value, times)| times * f(value)).sum()
    }

    fn add(&mut self, value: T, times: &[u32; FOLD]) {
        let times: u32 = times.iter().sum();
        if times > 0 {
            self.values.push(value);
            self.times.push(f64::from(times));
        }
    }
}

impl Census<f64> {
    /// Counts numbers, distinguished by their bits; `None` where too many of them differ.
    pub fn of(draws: &[f64]) -> Option<Self> {
        let mut table = ValueTable::EMPTY;
        let (rows, rest) = draws.as_chunks::<FOLD>();
        for row in rows.iter().map(|row| &row[..]).chain([rest]) {
            for (fold, x) in row.iter().enumerate() {
                let place = table.find(x.to_bits())?;
                table.times[place][fold] += 1;
            }
        }
        let mut census = Self::default();
        for (&bits, times) in table.bits.iter().zip(&table.times) {
            census.add(f64::from_bits(bits), times);
        }
        Some(census)
    }
}

/// Values by their bits. The marks of occupied places are read for every draw and change rarely. They are kept
/// apart from the counts, so that reading does not depend on a store.
struct ValueTable {
    bits: [u64; PLACES],
    taken: [bool; PLACES],
    times: [[u32; FOLD]; PLACES],
    used: usize,
}

impl ValueTable {
    const EMPTY: Self =
        Self { bits: [0; PLACES], taken: [false; PLACES], times: [[0; FOLD]; PLACES], used: 0 };

    /// Returns the place of a value, and occupies it for a new one; `None` where the table is full.
    #[inline(always)]
    fn find(&mut self, bits: u64) -> Option<usize> {
        // The upper bits of the product depend on all bits of the value.
        let mut place = (bits.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 57) as usize;
        loop {
            if self.taken[place] && self.bits[place] == bits {
                return Some(place);
            }
            if !self.taken[place] {
                self.used += 1;
                self.taken[place] = true;
                self.bits[place] = bits;
                return (self.used <= MAX_FILLED).then_some(place);
            }
            place = (place + 1) % PLACES;
        }
    }
}

impl Census<u32> {
    /// Counts integers; `None` where they are large, or too many of them differ.
    pub fn of(draws: &[u32]) -> Option<Self> {
        let largest = in_fused_code(
            #[inline(always)]
            || draws.iter().fold(0, |maximum, &n| maximum.max(n)),
        ) as usize;
        if largest > LARGEST || largest * WORTH > draws.len() {
            return None;
        }
        let mut times = vec![[0; FOLD]; largest + 1];
        let (rows, rest) = draws.as_chunks::<FOLD>();
        for row in rows.iter().map(|row| &row[..]).chain([rest]) {
            for (fold, &n) in row.iter().enumerate() {
                times[n as usize][fold] += 1;
            }
        }
        let mut census = Self::default();
        for (n, times) in (0..).zip(&times) {
            census.add(n, times);
        }
        Some(census)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_merge_to_the_whole() {
        let values: Vec<f64> = (0..1000).map(f64::from).collect();
        let mut merged = Tally::default();
        for block in values.chunks(64) {
            merged.merge(&Tally::of(block, 499.5, 1.0));
        }
        let moments = merged.moments().expect("draws");
        assert!(moments.mean.abs() < 1e-12);
        // The variance of 0 … n − 1 is n(n + 1)/12.
        assert!((moments.variance.expect("two draws") - 1000.0 * 1001.0 / 12.0).abs() < 1e-8);
    }

    #[test]
    fn counted_values_are_the_values_themselves() {
        let values: Vec<f64> = (0..999).map(|i| f64::from(i % 7) * 0.3 - 1.0).collect();
        let census = Census::<f64>::of(&values).expect("few");
        let (all, counted) = (Tally::of(&values, 0.1, 2.0), Tally::counted(&census, 0.1, 2.0));
        assert_eq!((counted.draws, counted.not_finite), (999, 0));
        let (a, b) = (all.moments().expect("draws"), counted.moments().expect("draws"));
        assert!((a.mean - b.mean).abs() < 1e-14);
        assert!((a.variance.expect("many") - b.variance.expect("many")).abs() < 1e-13);
        let census = Census::<f64>::of(&[1.0, f64::NAN, f64::NAN]).expect("few");
        assert_eq!(Tally::counted(&census, 0.0, 1.0).not_finite, 2);
    }

    #[test]
    fn a_tiny_spread_on_a_large_mean_survives() {
        let values: [f64; 2] = [1e9 + 1e-6, 1e9 - 1e-6];
        let exact = (values[0] - values[1]).powi(2) / 2.0;
        let variance = Tally::of(&values, 1e9, 1.0).moments().and_then(|m| m.variance);
        assert!((variance.expect("two draws") / exact - 1.0).abs() < 1e-12);
    }

    #[test]
    fn draws_that_are_not_numbers_are_counted() {
        assert_eq!(Tally::of(&[1.0, f64::NAN, f64::INFINITY], 0.0, 1.0).not_finite, 2);
    }

    #[test]
    fn each_value_is_counted_once() {
        let draws = [0.0, 1.5, 0.0, -0.0, 1.5, 0.0, f64::INFINITY];
        let census = Census::<f64>::of(&draws).expect("few");
        let mut counted: Vec<(u64, f64)> =
            census.values.iter().map(|x| x.to_bits()).zip(census.times.clone()).collect();
        counted.sort_by_key(|pair| pair.0);
        let zero = (0.0f64.to_bits(), 3.0);
        let others = [(1.5f64.to_bits(), 2.0), (f64::INFINITY.to_bits(), 1.0)];
        assert_eq!(counted, [zero, others[0], others[1], ((-0.0f64).to_bits(), 1.0)]);
    }

    #[test]
    fn sixty_four_values_are_few_and_sixty_five_are_not() {
        let values = |n: u32| (0..4096).map(|i| f64::from(i % n).sqrt()).collect::<Vec<_>>();
        let census = Census::<f64>::of(&values(64)).expect("few");
        assert_eq!(census.values.len(), 64);
        assert_eq!(census.times, [64.0; 64]);
        assert_eq!(Census::<f64>::of(&values(65)), None);
    }

    #[test]
    fn whole_numbers_are_counted_in_order() {
        let draws: Vec<u32> = (0..100).map(|i| i % 3 + 2).collect();
        let census = Census::<u32>::of(&draws).expect("few");
        assert_eq!((census.values, census.times), (vec![2, 3, 4], vec![34.0, 33.0, 33.0]));
        assert_eq!(Census::<u32>::of(&vec![5000; 100_000]), None);
        assert_eq!(Census::<u32>::of(&[]), Some(Census::default()));
    }

    #[test]
    fn a_sum_over_values_is_the_sum_over_draws() {
        let draws: Vec<u32> = (0..1000).map(|i| i * i % 7).collect();
        let census = Census::<u32>::of(&draws).expect("few");
        let whole: f64 = draws.iter().map(|&n| f64::from(n) + 0.5).sum();
        assert_eq!(census.sum(|&n| f64::from(n) + 0.5), whole);
    }
}

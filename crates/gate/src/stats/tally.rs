//! Sums of draws, block by block.

use super::Census;
use numeric::pack::in_fused_code;
use numeric::sum::Sum;

/// The sums side by side.
const LANES: usize = 16;

/// Sums of `y` and `y²`, where `y` is a draw less a known shift, in units of a known scale.
///
/// The shift is the predicted mean, so that a small spread on a large mean loses no digits. Within
/// a block the sums are plain; blocks are merged in the order of their addresses with compensated
/// sums, so that the result does not depend on who drew which block.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Tally {
    /// How many draws.
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
        // Many sums of each, whose additions need not wait for each other; they belong to the loop, which
        // keeps them in registers.
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

    /// The same of values that come so many times each.
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
}

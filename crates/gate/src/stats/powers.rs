//! Sums of powers of draws: their mean, variance and tails.

use numeric::fused::{self, Loop};
use numeric::sum::Sum;

/// Number of independent partial sums, so that additions do not depend on each other.
const LANES: usize = 8;
/// Below this share of `E[y²]` the difference `E[y²] − E[y]²` is rounding.
const RESOLUTION: f64 = 1e-13;

/// Sums of y, y², y³ and y⁴; the blocks of the first are summed in lanes, in a fixed order.
#[derive(Debug, Clone, Copy, Default)]
pub struct Powers {
    draws: u64,
    sums: [Sum; 4],
}

impl Powers {
    /// Adds a block, and returns the sum of its draws.
    pub fn absorb(&mut self, y: &[f64]) -> f64 {
        let mut lanes = [[0.0; LANES]; 4];
        fused::run(Rows { lanes: &mut lanes, y });
        for (sum, lanes) in self.sums.iter_mut().zip(&lanes) {
            sum.add(lanes.iter().sum());
        }
        self.draws += y.len() as u64;
        lanes[0].iter().sum()
    }

    /// Adds the sums of later draws.
    pub fn merge(&mut self, later: &Self) {
        self.draws += later.draws;
        self.sums.iter_mut().zip(&later.sums).for_each(|(sum, later)| sum.merge(later));
    }

    /// Number of draws.
    pub fn draws(&self) -> u64 {
        self.draws
    }

    /// The mean of yᵏ, k = 1 … 4.
    fn raw(&self, k: usize) -> f64 {
        self.sums[k - 1].value() / self.draws as f64
    }

    /// The mean of y.
    pub fn mean(&self) -> f64 {
        self.raw(1)
    }

    /// The mean of y².
    pub fn mean_square(&self) -> f64 {
        self.raw(2)
    }

    /// s², with `n − 1` in the denominator.
    pub fn variance(&self) -> f64 {
        let n = self.draws as f64;
        (self.raw(2) - self.raw(1) * self.raw(1)).max(0.0) * n / (n - 1.0).max(1.0)
    }

    /// The sample kurtosis; infinite for draws of variance 0.
    pub fn kurtosis(&self) -> f64 {
        let [m, m2, m3, m4] = [1, 2, 3, 4].map(|k| self.raw(k));
        let variance = m2 - m * m;
        let fourth = m4 - 4.0 * m * m3 + 6.0 * m * m * m2 - 3.0 * m * m * m * m;
        // A variance that is not larger than the rounding of the subtraction counts as 0.
        if variance > RESOLUTION * m2 { fourth / (variance * variance) } else { f64::INFINITY }
    }

    /// Number of draws that make the variance: n over the sample kurtosis; 0 for draws of variance 0.
    pub fn effective_draws(&self) -> f64 {
        self.draws as f64 / self.kurtosis()
    }

    /// An upper estimate of `E[y²]`: the mean of y² and three of its standard errors.
    pub fn upper_square(&self) -> f64 {
        let (square, fourth) = (self.raw(2), self.raw(4));
        square + 3.0 * ((fourth - square * square).max(0.0) / self.draws as f64).sqrt()
    }
}

/// Powers of draws, added lane by lane.
struct Rows<'a> {
    lanes: &'a mut [[f64; LANES]; 4],
    y: &'a [f64],
}

impl Loop for Rows<'_> {
    #[inline(always)]
    fn run(self) {
        let (rows, rest) = self.y.as_chunks::<LANES>();
        // An array of its own for each power: the compiler keeps each in registers.
        let [mut first, mut second, mut third, mut fourth] = *self.lanes;
        let mut add = |lane: usize, y: f64| {
            let square = y * y;
            first[lane] += y;
            second[lane] += square;
            third[lane] += square * y;
            fourth[lane] += square * square;
        };
        for row in rows {
            for (lane, &y) in row.iter().enumerate() {
                add(lane, y);
            }
        }
        for (lane, &y) in rest.iter().enumerate() {
            add(lane, y);
        }
        *self.lanes = [first, second, third, fourth];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_to_a_thousand() {
        let mut powers = Powers::default();
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) - 499.5).collect();
        for halves in values.chunks(154) {
            let mut both = Powers::default();
            halves.chunks(77).for_each(|block| _ = both.absorb(block));
            powers.merge(&both);
        }
        assert_eq!(powers.draws(), 1000);
        assert!(powers.mean().abs() < 1e-12);
        assert!((powers.variance() / (1000.0 * 1001.0 / 12.0) - 1.0).abs() < 1e-14);
        // 9/5 · (n² − 7/3)/(n² − 1).
        assert!((powers.kurtosis() - 1.8 * (1e6 - 7.0 / 3.0) / (1e6 - 1.0)).abs() < 1e-12);
    }

    #[test]
    pub fn draws_without_spread_have_no_tails() {
        let mut powers = Powers::default();
        powers.absorb(&[0.1; 1000]);
        assert!(powers.kurtosis().is_infinite());
        assert!((powers.upper_square() / 0.01 - 1.0).abs() < 1e-8);
    }
}

//! Sums that do not lose their small terms.

/// A running sum with its rounding error kept beside it.
///
/// ```text
/// s ← s + x,  c ← c + (what the addition rounded away);  value = s + c
/// ```
///
/// Source: A. Neumaier, *Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen*,
/// ZAMM 54 (1974), 39–51.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Sum {
    sum: f64,
    correction: f64,
}

impl Sum {
    /// Adds one term.
    #[inline]
    pub fn add(&mut self, x: f64) {
        let total = self.sum + x;
        // An infinite sum stays infinite: nothing is rounded away that could be told.
        if total.is_finite() {
            let (large, small) =
                if self.sum.abs() >= x.abs() { (self.sum, x) } else { (x, self.sum) };
            self.correction += (large - total) + small;
        }
        self.sum = total;
    }

    /// Adds another sum, its correction included.
    pub fn merge(&mut self, other: &Self) {
        self.add(other.sum);
        self.correction += other.correction;
    }

    /// The sum so far.
    pub fn value(&self) -> f64 {
        self.sum + self.correction
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        terms.into_iter().for_each(|x| sum.add(x));
        sum
    }
}

/// Additions that need not wait for each other: as long as one takes, four of a register's may begin.
const LANES: usize = 16;

/// `Σ f(x)` in sixteen lanes.
#[inline(always)]
pub fn sum_in_lanes(values: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    let (rows, rest) = values.as_chunks::<LANES>();
    let mut lanes = [0.0; LANES];
    for row in rows {
        for (lane, &x) in lanes.iter_mut().zip(row) {
            *lane += f(x);
        }
    }
    lanes.iter().sum::<f64>() + rest.iter().map(|&x| f(x)).sum::<f64>()
}

/// `Σ f(x, y)` over two lists of the same length, likewise.
#[inline]
pub fn sum_of_pairs(x: &[f64], y: &[f64], f: impl Fn(f64, f64) -> f64) -> f64 {
    let ((x, last_x), (y, last_y)) = (x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
    let mut lanes = [0.0; LANES];
    for (x, y) in x.iter().zip(y) {
        for (lane, (&x, &y)) in lanes.iter_mut().zip(x.iter().zip(y)) {
            *lane += f(x, y);
        }
    }
    let rest = last_x.iter().zip(last_y).map(|(&x, &y)| f(x, y));
    lanes.iter().sum::<f64>() + rest.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_in_lanes_leave_nothing_out() {
        for count in [0, 7, 16, 37] {
            let x: Vec<f64> = (0..count).map(f64::from).collect();
            let whole: f64 = x.iter().sum();
            assert_eq!(sum_in_lanes(&x, |x| 2.0 * x), 2.0 * whole);
            assert_eq!(sum_of_pairs(&x, &x, |x, y| x + y), 2.0 * whole);
        }
    }

    #[test]
    fn small_terms_survive_a_large_one() {
        let sum: Sum = [1.0, 1e100, 1.0, -1e100].into_iter().collect();
        assert_eq!(sum.value(), 2.0);
    }

    #[test]
    fn an_infinite_sum_is_infinite() {
        let sum: Sum = [1.0, f64::INFINITY, 1.0].into_iter().collect();
        assert_eq!(sum.value(), f64::INFINITY);
    }
}

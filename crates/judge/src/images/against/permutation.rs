//! Two groups of rows, compared with all ways to deal the rows to two groups: many columns at once.
//!
//! ```text
//! t_j  = (ā_j − b̄_j)/√(w v_j(1/N + 1/M) + (1 − w)(s_a²/N + s_b²/M)),    w = 8/(N + M + 6)
//! p_j  = (1 + how many of B random deals have a |t_j| as large)/(1 + B)
//! p̃_j  the same of the largest |t| of all columns with a |t| up to that of j: all columns at once, at one level
//! ```
//!
//! If the N + M rows are independent and of one distribution, every deal is equally likely: `p` and `p̃` are exact,
//! `P(p ≤ α) ≤ α`, for any number of rows, any distribution and any dependence of the columns. `v_j` is a prior
//! variance that does not depend on the deal; it steadies the variance of few rows. With different distributions of one
//! mean the level holds for many rows only, where averages are nearly normal: `t` is in units of the groups' own
//! standard errors.
//!
//! Sources: A. Janssen, *Studentized permutation tests for non-i.i.d. hypotheses and the generalized Behrens–Fisher
//! problem*, Statistics & Probability Letters 36 (1997); E. Chung, J. Romano, *Exact and asymptotically robust permutation
//! tests*, Annals of Statistics 41 (2013); P. Westfall, S. Young, *Resampling-Based Multiple Testing* (1993), for `p̃`;
//! B. Phipson, G. Smyth, *Permutation p-values should never be zero*, SAGMB 9 (2010); G. Smyth, SAGMB 3 (2004), for `v`.

use numeric::rng::{Address, unit};
use theory::parallel;

/// Number of rows that the prior variance counts as.
const PRIOR: f64 = 8.0;
/// Number of deals with a largest |t| as large at which the comparison ends.
const ENOUGH: u64 = 20;
/// Number of parts of a round of deals.
const PARTS: u64 = 16;
/// Minimum and maximum number of deals.
const MIN_DEALS: u64 = 1000;
const MAX_DEALS: u64 = 200_000;

/// Rows of two groups, with one column per question.
#[derive(Debug)]
pub struct Groups {
    /// Rows one after the other, those of the first group first; each column has mean 0.
    values: Vec<f64>,
    rows: [usize; 2],
    prior: Vec<f64>,
    /// Sum of squares of each column.
    squares: Vec<f64>,
}

/// p-values of all columns.
#[derive(Debug, Clone)]
pub struct ColumnPValues {
    /// t of each column.
    pub t: Vec<f64>,
    /// p of each column by itself.
    pub p: Vec<f64>,
    /// p̃, the p-value of all columns together.
    pub adjusted: Vec<f64>,
    /// Number of deals that were compared.
    pub deals: u64,
}

/// Returns the number of deals of `first` and `second` rows with distinct |t|.
pub fn distinct(first: usize, second: usize) -> f64 {
    let ways = (1..=first).map(|k| (second + k) as f64 / k as f64).product::<f64>();
    if first == second { 0.5 * ways } else { ways }
}

impl Groups {
    /// Takes two groups of rows with a column for each prior variance; columns without any spread have t = 0.
    pub fn new(mut values: Vec<f64>, rows: [usize; 2], prior: &[f64]) -> Self {
        let columns = prior.len();
        let all = (rows[0] + rows[1]) as f64;
        let mut means = vec![0.0; columns];
        for row in values.chunks_exact(columns) {
            means.iter_mut().zip(row).for_each(|(mean, x)| *mean += x / all);
        }
        let mut squares = vec![0.0; columns];
        for row in values.chunks_exact_mut(columns) {
            for ((x, mean), sum) in row.iter_mut().zip(&means).zip(&mut squares) {
                *x -= mean;
                // Rounding error of a column without spread.
                if x.abs() <= 1e-12 * mean.abs() {
                    *x = 0.0;
                }
                *sum += *x * *x;
            }
        }
        Self { values, rows, prior: prior.to_vec(), squares }
    }

    /// Returns t of all columns if the first group has these rows.
    fn statistics(&self, chosen: &[usize]) -> Vec<f64> {
        let columns = self.prior.len();
        let (mut sums, mut squares) = (vec![0.0; columns], vec![0.0; columns]);
        for &row in chosen {
            let row = &self.values[row * columns..(row + 1) * columns];
            for ((x, sum), square) in row.iter().zip(&mut sums).zip(&mut squares) {
                *sum += x;
                *square += x * x;
            }
        }
        let [n, m] = self.rows.map(|rows| rows as f64);
        let (degrees, both) = (n + m - 2.0, 1.0 / n + 1.0 / m);
        (0..columns)
            .map(|j| {
                let (sum, square) = (sums[j], squares[j]);
                let first = (square - sum * sum / n).max(0.0) / ((n - 1.0) * n);
                let second = (self.squares[j] - square - sum * sum / m).max(0.0) / ((m - 1.0) * m);
                let own = degrees * (first + second);
                let variance = (PRIOR * self.prior[j] * both + own) / (PRIOR + degrees);
                let t = sum * both / variance.sqrt();
                if t.is_finite() { t } else { 0.0 }
            })
            .collect()
    }

    /// Compares the groups as they are with random deals, as many as the level `alpha` needs.
    pub fn compare(&self, alpha: f64, seed: u64) -> ColumnPValues {
        let all = self.rows[0] + self.rows[1];
        let t = self.statistics(&(0..self.rows[0]).collect::<Vec<_>>());
        let mut order: Vec<usize> = (0..t.len()).collect();
        order.sort_by(|&i, &j| t[i].abs().total_cmp(&t[j].abs()));
        // A deal adds up in another order, with other rounding.
        let limits: Vec<f64> = t.iter().map(|t| t.abs() * (1.0 - 1e-9)).collect();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most 200,000
        let required = ((ENOUGH as f64 / alpha).ceil().min(MAX_DEALS as f64) as u64).max(MIN_DEALS);
        let each = MIN_DEALS.div_ceil(PARTS);
        let (mut above, mut largest) = (vec![0_u64; t.len()], vec![0_u64; t.len()]);
        let mut deals = 0;
        let top = order.last().copied();
        while deals < required && top.is_some_and(|top| deals == 0 || largest[top] < ENOUGH) {
            let parts = parallel::numbered(PARTS, |part| {
                let block = deals / each + part;
                let mut rng = Address { seed, experiment: 1, block, lane: 0 }.stream();
                let mut rows: Vec<usize> = (0..all).collect();
                let mut counts = (vec![0_u64; t.len()], vec![0_u64; t.len()]);
                for _ in 0..each {
                    for place in 0..self.rows[0] {
                        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                        let other = place + (unit(&mut rng) * (all - place) as f64) as usize;
                        rows.swap(place, other.min(all - 1));
                    }
                    let dealt = self.statistics(&rows[..self.rows[0]]);
                    let mut maximum: f64 = 0.0;
                    for &column in &order {
                        let size = dealt[column].abs();
                        maximum = maximum.max(size);
                        counts.0[column] += u64::from(size >= limits[column]);
                        counts.1[column] += u64::from(maximum >= limits[column]);
                    }
                }
                counts
            });
            for (own, joint) in parts {
                above.iter_mut().zip(own).for_each(|(sum, count)| *sum += count);
                largest.iter_mut().zip(joint).for_each(|(sum, count)| *sum += count);
            }
            deals += PARTS * each;
        }
        let share = |count: u64| (1 + count) as f64 / (1 + deals) as f64;
        let mut adjusted = vec![1.0; t.len()];
        let mut minimum: f64 = 0.0;
        for &column in order.iter().rev() {
            minimum = minimum.max(share(largest[column]));
            adjusted[column] = minimum;
        }
        ColumnPValues { p: above.into_iter().map(share).collect(), t, adjusted, deals }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(seed: u64, n: usize, columns: usize, shift: f64) -> Vec<f64> {
        let mut rng = Address { seed, experiment: 22, block: 0, lane: 0 }.stream();
        let mut value = |row: usize| unit(&mut rng).powi(6) + if row < n / 2 { shift } else { 0.0 };
        (0..n).flat_map(|row| vec![row; columns]).map(&mut value).collect()
    }

    #[test]
    fn one_distribution_has_even_p_values() {
        let (mut alone, mut together) = (0, 0);
        for seed in 0..200 {
            let groups = Groups::new(rows(seed, 12, 5, 0.0), [6, 6], &[0.05; 5]);
            let finding = groups.compare(0.1, 1);
            alone += usize::from(finding.p[0] <= 0.1);
            together += usize::from(finding.adjusted.iter().any(|&p| p <= 0.1));
        }
        // Binomial(200, 0.1): 20 ± 4.2.
        assert!((4..=37).contains(&alone) && (4..=37).contains(&together), "{alone} {together}");
    }

    #[test]
    fn a_shift_of_one_column_is_found_there() {
        let mut values = rows(3, 40, 4, 0.0);
        values.iter_mut().step_by(4).take(20).for_each(|x| *x += 0.6);
        let finding = Groups::new(values, [20, 20], &[0.05; 4]).compare(1e-3, 1);
        assert!(finding.adjusted[0] <= 1e-3 && finding.t[0] > 4.0, "{finding:?}");
        assert!(finding.adjusted[1..].iter().all(|&p| p > 1e-3), "{finding:?}");
    }

    #[test]
    fn few_rows_have_few_deals() {
        // C(4, 2)/2, C(5, 2), C(16, 8)/2.
        assert_eq!((distinct(2, 2), distinct(2, 3)), (3.0, 10.0));
        assert!((distinct(8, 8) - 6435.0).abs() < 1e-9);
        // The rows of both groups are as far apart as possible: 1 of 3 deals.
        let finding = Groups::new(vec![0.0, 0.1, 5.0, 5.1], [2, 2], &[0.0]).compare(1e-3, 1);
        assert!((finding.p[0] - 1.0 / 3.0).abs() < 0.1, "{finding:?}");
        let flat = Groups::new(vec![0.3; 6], [3, 3], &[0.0]).compare(1e-3, 1);
        assert_eq!((flat.t[0], flat.p[0]), (0.0, 1.0));
    }
}

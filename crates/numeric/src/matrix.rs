//! Small dense matrices.

use super::fused::in_fused_code;

/// A matrix, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    columns: usize,
    entries: Vec<f64>,
}

impl Matrix {
    /// Made entry by entry, from the row and the column of each; at least one column.
    pub fn new(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let columns = columns.max(1);
        let places = (0..rows * columns).map(|place| (place / columns, place % columns));
        Self { columns, entries: places.map(|(row, column)| entry(row, column)).collect() }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.entries.len() / self.columns
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// A row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.entries[row * self.columns..][..self.columns]
    }

    /// An entry.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.row(row)[column]
    }

    /// Adds a number to an entry.
    pub fn add(&mut self, row: usize, column: usize, x: f64) {
        self.entries[row * self.columns + column] += x;
    }

    /// The first rows, as many as there are columns: of a matrix with further rows below, the square.
    #[must_use]
    pub fn square(&self) -> Self {
        let entries = self.entries[..self.columns * self.columns].to_vec();
        Self { columns: self.columns, entries }
    }

    /// The sum of both.
    #[must_use]
    pub fn plus(mut self, other: &Self) -> Self {
        for (entry, x) in self.entries.iter_mut().zip(&other.entries) {
            *entry += x;
        }
        self
    }

    /// The sum of the first and the second, of which each row is multiplied by its factor.
    #[must_use]
    pub fn plus_rows(mut self, factors: &[f64], other: &Self) -> Self {
        let rows = self.entries.chunks_mut(self.columns).zip(other.entries.chunks(self.columns));
        for ((row, others), factor) in rows.zip(factors) {
            for (entry, x) in row.iter_mut().zip(others) {
                *entry += factor * x;
            }
        }
        self
    }

    /// The product with the first rows of another matrix, as many as this one has columns.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let columns = other.columns;
        let mut entries = vec![0.0; self.rows() * columns];
        in_fused_code(
            #[inline(always)]
            || multiply(self, other, &mut entries),
        );
        Self { columns, entries }
    }

    /// The product with a vector of which the first entries count, as many as there are columns.
    pub fn applied(&self, vector: &[f64]) -> Vec<f64> {
        let rows = self.entries.chunks(self.columns);
        rows.map(|row| row.iter().zip(vector).map(|(x, y)| x * y).sum()).collect()
    }

    /// `(1 − A)⁻¹ b`, see [`Self::series_times`].
    pub fn series(&self, b: &[f64]) -> Option<Vec<f64>> {
        let found = self.series_times(&Self { columns: 1, entries: b.to_vec() })?;
        Some(found.entries)
    }

    /// The X with `(1 − A) X = B`, of A the square and of B as many rows; `None` unless every pivot
    /// of `1 − A` is positive. For `A ≥ 0` these are positive exactly where the series
    /// `1 + A + A² + …` converges (A. Berman, R. J. Plemmons, *Nonnegative Matrices in the
    /// Mathematical Sciences*, 1979, chapter 6), and then X is its product with B.
    pub fn series_times(&self, other: &Self) -> Option<Self> {
        let (n, columns) = (self.columns, other.columns);
        let mut left: Vec<f64> = self.entries[..n * n].iter().map(|x| -x).collect();
        for i in 0..n {
            left[i * n + i] += 1.0;
        }
        let mut entries = other.entries[..n * columns].to_vec();
        let solved = in_fused_code(
            #[inline(always)]
            || eliminate(&mut left, n, &mut entries, columns),
        );
        solved.then_some(Self { columns, entries })
    }
}

#[inline(always)]
fn multiply(a: &Matrix, b: &Matrix, product: &mut [f64]) {
    let n = b.columns;
    let mut sums = product.chunks_exact_mut(2 * n);
    let mut rows = a.entries.chunks_exact(2 * a.columns);
    // Two rows at a time: each row of the second matrix is read half as often.
    for (sums, rows) in (&mut sums).zip(&mut rows) {
        let (first, second) = sums.split_at_mut(n);
        let (above, below) = rows.split_at(a.columns);
        for ((&x, &y), entries) in above.iter().zip(below).zip(b.entries.chunks_exact(n)) {
            for ((p, q), z) in first.iter_mut().zip(second.iter_mut()).zip(entries) {
                *p = x.mul_add(*z, *p);
                *q = y.mul_add(*z, *q);
            }
        }
    }
    let last = sums.into_remainder();
    for (&x, entries) in rows.remainder().iter().zip(b.entries.chunks_exact(n)) {
        for (p, z) in last.iter_mut().zip(entries) {
            *p = x.mul_add(*z, *p);
        }
    }
}

/// Gauss elimination without exchanges; answers whether all pivots are positive.
#[inline(always)]
fn eliminate(left: &mut [f64], n: usize, right: &mut [f64], columns: usize) -> bool {
    for k in 0..n {
        let pivot = left[k * n + k];
        // What is no number is no pivot either.
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let (above, below) = left.split_at_mut((k + 1) * n);
        let (done, open) = right.split_at_mut((k + 1) * columns);
        let (pivots, sources) = (&above[k * n + k..], &done[k * columns..]);
        for (row, target) in below.chunks_exact_mut(n).zip(open.chunks_exact_mut(columns)) {
            let factor = -row[k] / pivot;
            for (entry, x) in row[k..].iter_mut().zip(pivots) {
                *entry = factor.mul_add(*x, *entry);
            }
            for (entry, x) in target.iter_mut().zip(sources) {
                *entry = factor.mul_add(*x, *entry);
            }
        }
    }
    for k in (0..n).rev() {
        let (above, solved) = right.split_at_mut(k * columns);
        let row = &mut solved[..columns];
        let scale = 1.0 / left[k * n + k];
        for entry in row.iter_mut() {
            *entry *= scale;
        }
        for (i, target) in above.chunks_exact_mut(columns).enumerate() {
            let factor = -left[i * n + k];
            for (entry, x) in target.iter_mut().zip(row.iter()) {
                *entry = factor.mul_add(*x, *entry);
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_worked_by_hand() {
        // Three rows, the last one alone; the second matrix has a row too many.
        let a = Matrix::new(3, 2, |i, j| (1 + 2 * i + j) as f64);
        let b = Matrix::new(3, 2, |i, j| (i * 10 + j) as f64);
        let c = a.times(&b);
        let expected = [[20.0, 23.0], [40.0, 47.0], [60.0, 71.0]];
        for (i, row) in expected.iter().enumerate() {
            assert_eq!(c.row(i), row);
        }
        assert_eq!(a.applied(&[1.0, 10.0]), [21.0, 43.0, 65.0]);
    }

    #[test]
    fn the_series_is_the_inverse_where_it_converges() {
        // A = [[.5, .25], [.25, .5]] has the eigenvalues 3/4 and 1/4: the inverse of 1 − A is
        // [[8, 4], [4, 8]]/3.
        let of = |x: f64| Matrix::new(2, 2, move |i, j| if i == j { x } else { 0.5 * x });
        let one = Matrix::new(2, 2, |i, j| f64::from(u8::from(i == j)));
        let inverse = of(0.5).series_times(&one).expect("converges");
        for (i, row) in [[8.0, 4.0], [4.0, 8.0]].iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert!((inverse.at(i, j) - x / 3.0).abs() < 1e-15);
            }
        }
        assert_eq!(of(0.5).series(&[1.0, 0.0]), Some(vec![inverse.at(0, 0), inverse.at(1, 0)]));
        // An eigenvalue of 1.02: the inverse exists, the series does not.
        assert_eq!(of(0.68).series_times(&one), None);
    }
}

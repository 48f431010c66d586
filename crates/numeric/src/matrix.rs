//! Small dense matrices of doubles or of truncated power series.

use std::marker::PhantomData;

use super::fused::in_fused_code;
use super::jet::Scalar;

/// A matrix. All constant terms come first, row by row, then all linear terms, and so on.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix<S = f64> {
    columns: usize,
    entries: Vec<f64>,
    scalar: PhantomData<S>,
}

impl<S: Scalar> Matrix<S> {
    /// Made entry by entry, from the row and the column of each; at least one column.
    #[inline]
    pub fn new(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> S) -> Self {
        let columns = columns.max(1);
        let size = rows * columns;
        let mut made = Self::of_entries(columns, vec![0.0; S::TERMS * size]);
        for place in 0..size {
            let scalar = entry(place / columns, place % columns);
            for term in 0..S::TERMS {
                made.entries[term * size + place] = scalar.term(term);
            }
        }
        made
    }

    #[inline]
    fn of_entries(columns: usize, entries: Vec<f64>) -> Self {
        Self { columns, entries, scalar: PhantomData }
    }

    /// Number of entries.
    #[inline]
    fn size(&self) -> usize {
        self.entries.len() / S::TERMS
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.size() / self.columns
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The entries of a row.
    #[inline]
    pub fn row(&self, row: usize) -> impl Iterator<Item = S> + '_ {
        (0..self.columns).map(move |column| self.at(row, column))
    }

    /// An entry.
    #[inline]
    pub fn at(&self, row: usize, column: usize) -> S {
        let size = self.size();
        S::of_terms(|term| self.entries[term * size + row * self.columns + column])
    }

    /// Adds a number to an entry.
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, x: S) {
        let size = self.size();
        for term in 0..S::TERMS {
            self.entries[term * size + row * self.columns + column] += x.term(term);
        }
    }

    /// The coefficients of one power of y.
    #[inline]
    fn terms(&self, index: usize) -> &[f64] {
        let size = self.size();
        &self.entries[index * size..][..size]
    }

    /// The first rows, as many as there are columns: of a matrix with further rows below, the square.
    #[must_use]
    pub fn square(&self) -> Self {
        let size = self.columns * self.columns;
        let squares = (0..S::TERMS).flat_map(|index| &self.terms(index)[..size]);
        Self::of_entries(self.columns, squares.copied().collect())
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
    pub fn plus_rows(mut self, factors: &[S], other: &Self) -> Self {
        let (size, columns) = (self.size(), self.columns);
        for (index, sums) in self.entries.chunks_exact_mut(size).enumerate() {
            for of_factor in 0..=index {
                let rows = other.terms(index - of_factor).chunks_exact(columns);
                for ((sums, row), factor) in sums.chunks_exact_mut(columns).zip(rows).zip(factors) {
                    let factor = factor.term(of_factor);
                    sums.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
                }
            }
        }
        self
    }

    /// The product with the first rows of another matrix, as many as this one has columns.
    #[must_use]
    pub fn times(&self, other: &Self) -> Self {
        let (size, columns) = (self.rows() * other.columns, other.columns);
        let mut entries = vec![0.0; S::TERMS * size];
        in_fused_code(
            #[inline(always)]
            || {
                for index in 0..S::TERMS {
                    let sums = &mut entries[index * size..][..size];
                    for first in 0..=index {
                        let second = other.terms(index - first);
                        multiply([self.terms(first), second], self.columns, columns, sums);
                    }
                }
            },
        );
        Self::of_entries(columns, entries)
    }

    /// The product with a vector of which the first entries count, as many as there are columns.
    pub fn applied(&self, vector: &[S]) -> Vec<S> {
        let product = |row| {
            let terms = self.row(row).zip(vector).map(|(x, &y)| x * y);
            terms.fold(S::from(0.0), |sum, term| sum + term)
        };
        (0..self.rows()).map(product).collect()
    }

    /// `(1 − A)⁻¹ b`, see [`Self::series_times`].
    pub fn series(&self, b: &[S]) -> Option<Vec<S>> {
        let result = self.series_times(&Self::new(b.len(), 1, |row, _| b[row]))?;
        Some((0..result.rows()).map(|row| result.at(row, 0)).collect())
    }

    /// The X with `(1 − A) X = B`, of A the square and of B as many rows; `None` unless every pivot of the
    /// constant terms of `1 − A` is positive.
    ///
    /// For `A ≥ 0` these are positive exactly where the series `1 + A + A² + …` converges, and then X is its product
    /// with B. All powers of y have the same factors, and further right-hand sides:
    ///
    /// ```text
    /// (1 − A₀) X_k = B_k + A₁X_{k−1} + … + A_kX₀
    /// ```
    ///
    /// Source: A. Berman, R. J. Plemmons, *Nonnegative Matrices in the Mathematical Sciences* (1979), chapter 6.
    pub fn series_times(&self, other: &Self) -> Option<Self> {
        let (n, columns) = (self.columns, other.columns);
        let mut left: Vec<f64> = self.entries[..n * n].iter().map(|x| -x).collect();
        for i in 0..n {
            left[i * n + i] += 1.0;
        }
        let size = n * columns;
        let right = (0..S::TERMS).flat_map(|index| &other.terms(index)[..size]);
        let mut entries: Vec<f64> = right.copied().collect();
        let solved = in_fused_code(
            #[inline(always)]
            || {
                if !factorize(&mut left, n) {
                    return false;
                }
                for index in 0..S::TERMS {
                    let (solved, rest) = entries.split_at_mut(index * size);
                    let open = &mut rest[..size];
                    for first in 1..=index {
                        let second = &solved[(index - first) * size..][..size];
                        multiply([&self.terms(first)[..n * n], second], n, columns, open);
                    }
                    substitute(&left, n, open, columns);
                }
                true
            },
        );
        solved.then(|| Self::of_entries(columns, entries))
    }
}

/// Adds the product of two matrices to sums: `inner` is the number of columns of the first, `n` that of the second.
#[inline(always)]
fn multiply([a, b]: [&[f64]; 2], inner: usize, n: usize, sums: &mut [f64]) {
    for (row, sums) in sums.chunks_exact_mut(n).enumerate() {
        add_rows(sums, &a[row * inner..][..inner], b);
    }
}

/// Adds rows, each multiplied by its factor. Four at a time: sums are read and written less often. Loops count, since
/// iterators that are zipped are not inlined in fused code.
#[inline(always)]
fn add_rows(sums: &mut [f64], factors: &[f64], rows: &[f64]) {
    let n = sums.len();
    let even = factors.len() - factors.len() % 4;
    for k in (0..even).step_by(4) {
        let (first, second) = (&rows[k * n..][..n], &rows[(k + 1) * n..][..n]);
        let (third, fourth) = (&rows[(k + 2) * n..][..n], &rows[(k + 3) * n..][..n]);
        let [a, b, c, d] = [factors[k], factors[k + 1], factors[k + 2], factors[k + 3]];
        for i in 0..n {
            let half = b.mul_add(second[i], a.mul_add(first[i], sums[i]));
            sums[i] = d.mul_add(fourth[i], c.mul_add(third[i], half));
        }
    }
    for k in even..factors.len() {
        add_row(sums, factors[k], &rows[k * n..][..n]);
    }
}

/// Adds a row multiplied by its factor.
#[inline(always)]
fn add_row(sums: &mut [f64], factor: f64, row: &[f64]) {
    let row = &row[..sums.len()];
    for i in 0..row.len() {
        sums[i] = factor.mul_add(row[i], sums[i]);
    }
}

/// Gauss elimination without exchanges; returns true if all pivots are positive. Below the diagonal the factors are
/// kept by which rows were subtracted.
#[inline(always)]
fn factorize(left: &mut [f64], n: usize) -> bool {
    for k in 0..n {
        let pivot = left[k * n + k];
        // What is no number is no pivot either.
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let (above, below) = left.split_at_mut((k + 1) * n);
        let pivots = &above[k * n + k + 1..];
        for row in below.chunks_exact_mut(n) {
            let factor = -row[k] / pivot;
            row[k] = factor;
            add_row(&mut row[k + 1..], factor, pivots);
        }
    }
    true
}

/// Solves the factorized equations for all columns of a right-hand side.
#[inline(always)]
fn substitute(left: &[f64], n: usize, right: &mut [f64], columns: usize) {
    for k in 1..n {
        let (done, open) = right.split_at_mut(k * columns);
        add_rows(&mut open[..columns], &left[k * n..][..k], done);
    }
    for k in (0..n).rev() {
        let (above, solved) = right.split_at_mut(k * columns);
        let row = &mut solved[..columns];
        let scale = 1.0 / left[k * n + k];
        for entry in row.iter_mut() {
            *entry *= scale;
        }
        for (i, target) in above.chunks_exact_mut(columns).enumerate() {
            add_row(target, -left[i * n + k], row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::jet::Jet;

    #[test]
    fn a_product_worked_by_hand() {
        // Three rows, the last one alone; the second matrix has a row too many.
        let a = Matrix::new(3, 2, |i, j| (1 + 2 * i + j) as f64);
        let b = Matrix::new(3, 2, |i, j| (i * 10 + j) as f64);
        let c = a.times(&b);
        let expected = [[20.0, 23.0], [40.0, 47.0], [60.0, 71.0]];
        for (i, row) in expected.iter().enumerate() {
            assert!(c.row(i).eq(*row));
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

    /// A and B of four terms: (1 − A)X is B again, and constant terms are those of doubles.
    #[test]
    fn series_solve_the_equations_of_series() {
        let number = |i: usize, j: usize, k: usize| ((7 * i + 5 * j + 3 * k) % 11) as f64 / 80.0;
        let matrix = |columns: usize| {
            Matrix::<Jet<4>>::new(9, columns, |i, j| Jet::of_terms(|k| number(i, j, k)))
        };
        let (a, b) = (matrix(9), matrix(10));
        let x = a.series_times(&b).expect("converges");
        let product = a.times(&x);
        for i in 0..9 {
            for j in 0..10 {
                for k in 0..4 {
                    let result = x.at(i, j).term(k) - product.at(i, j).term(k);
                    assert!((result - b.at(i, j).term(k)).abs() < 1e-12);
                }
            }
        }
        let constant =
            |a: &Matrix<Jet<4>>| Matrix::new(9, a.columns(), |i, j| a.at(i, j).leading());
        assert_eq!(constant(&a).series_times(&constant(&b)), Some(constant(&x)));
        let factors: Vec<Jet<4>> = (0..9).map(|i| b.at(i, 9)).collect();
        let rows = Matrix::<Jet<4>>::new(9, 10, |_, _| Jet::from(0.0)).plus_rows(&factors, &b);
        assert_eq!(rows.at(3, 4), factors[3] * b.at(3, 4));
        assert_eq!(
            a.applied(&factors)[2],
            a.row(2).zip(&factors).fold(Jet::from(0.0), |sum, (x, &y)| sum + x * y)
        );
    }
}

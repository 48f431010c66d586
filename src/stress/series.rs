//! Power series in 32 digits, and linear equations: what references are made of.

use std::iter::Sum;
use std::ops::{Div, Mul, Sub};

use numeric::Wide;

/// `xᵏ`.
pub(super) fn power(x: Wide, k: usize) -> Wide {
    (0..k).fold(Wide::ONE, |power, _| power * x)
}

/// In how many ways so many are chosen of all.
pub(super) fn binomial(all: usize, chosen: usize) -> f64 {
    (0..chosen).fold(1.0, |ways, i| ways * (all - i) as f64 / (i + 1) as f64)
}

/// The n-th coefficient of a product.
pub(super) fn coefficient(a: &[Wide], b: &[Wide], n: usize) -> Wide {
    (0..=n).map(|i| a[i] * b[n - i]).sum()
}

/// `Σ aₙ tⁿ`.
pub(super) fn value(series: &[Wide], t: Wide) -> Wide {
    series.iter().rev().fold(Wide::default(), |sum, &a| sum * t + a)
}

/// The solutions of equations whose rows end with so many right sides, by elimination: with the largest pivot
/// of a column, by a size, or with the diagonal.
pub(super) fn solved<T, const SIDES: usize>(
    mut rows: Vec<Vec<T>>,
    size: impl Fn(T) -> f64,
    is_pivoted: bool,
) -> Option<Vec<[T; SIDES]>>
where
    T: Copy + Default + Sub<Output = T> + Mul<Output = T> + Div<Output = T> + Sum,
{
    let n = rows.len();
    for column in 0..n {
        if is_pivoted {
            let size = |i: &usize| size(rows[*i][column]);
            let pivot = (column..n).max_by(|i, j| size(i).total_cmp(&size(j)))?;
            rows.swap(column, pivot);
        }
        let (done, below) = rows.split_at_mut(column + 1);
        let first = &done[column];
        if size(first[column]) == 0.0 {
            return None;
        }
        for row in below {
            let factor = row[column] / first[column];
            for (x, &y) in row.iter_mut().zip(first).skip(column) {
                *x = *x - factor * y;
            }
        }
    }
    let mut solution = vec![[T::default(); SIDES]; n];
    for i in (0..n).rev() {
        for side in 0..SIDES {
            let known: T = (i + 1..n).map(|j| rows[i][j] * solution[j][side]).sum();
            solution[i][side] = (rows[i][n + side] - known) / rows[i][i];
        }
    }
    Some(solution)
}

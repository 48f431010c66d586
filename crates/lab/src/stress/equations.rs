//! Linear equations, powers and binomial coefficients of oracles.

use std::iter::Sum;
use std::ops::{Div, Mul, Sub};

use numeric::DoubleDouble;

/// Returns `xᵏ`.
pub(super) fn power(x: DoubleDouble, k: usize) -> DoubleDouble {
    (0..k).fold(DoubleDouble::ONE, |power, _| power * x)
}

/// Returns the binomial coefficient C(n, k).
pub(super) fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |ways, i| ways * (n - i) as f64 / (i + 1) as f64)
}

/// Solves equations by elimination; rows end with some right sides: with the largest pivot
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

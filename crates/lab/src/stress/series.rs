//! Power series in 32 digits, and linear equations, from which references are made.

use std::iter::Sum;
use std::ops::{Div, Mul, Sub};

use numeric::Wide;

/// `Σ aₙ tⁿ`, cut off.
pub(super) type Series<const N: usize> = [Wide; N];

/// Returns a constant.
pub(super) fn constant<const N: usize>(value: Wide) -> Series<N> {
    let mut series = [Wide::default(); N];
    series[0] = value;
    series
}

/// Returns `value · e^{rate·t}`.
pub(super) fn exponential<const N: usize>(value: Wide, rate: Wide) -> Series<N> {
    let mut series = constant(value);
    for n in 1..N {
        series[n] = series[n - 1] * rate / n as f64;
    }
    series
}

/// Returns a product.
pub(super) fn product<const N: usize>(a: &Series<N>, b: &Series<N>) -> Series<N> {
    std::array::from_fn(|n| coefficient(a, b, n))
}

/// Returns `1/a`.
pub(super) fn inverse<const N: usize>(a: &Series<N>) -> Series<N> {
    let mut series = constant(1.0 / a[0]);
    for n in 1..N {
        let known: Wide = (0..n).map(|i| series[i] * a[n - i]).sum();
        series[n] = -known / a[0];
    }
    series
}

/// Adds a multiple of a series to another.
pub(super) fn add<const N: usize>(sum: &mut Series<N>, factor: Wide, series: &Series<N>) {
    sum.iter_mut().zip(series).for_each(|(sum, &a)| *sum += factor * a);
}

/// Returns `Σ aₙ tⁿ`.
pub(super) fn value(series: &[Wide], t: Wide) -> Wide {
    series.iter().rev().fold(Wide::default(), |sum, &a| sum * t + a)
}

/// Returns the n-th coefficient of a product.
pub(super) fn coefficient(a: &[Wide], b: &[Wide], n: usize) -> Wide {
    (0..=n).map(|i| a[i] * b[n - i]).sum()
}

/// Returns `xᵏ`.
pub(super) fn power(x: Wide, k: usize) -> Wide {
    (0..k).fold(Wide::ONE, |power, _| power * x)
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

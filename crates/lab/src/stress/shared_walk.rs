//! Moments of a mean of points that share a walk, from those of what they score together.

use std::iter::Sum;
use std::ops::{Div, Mul};

/// All products of up to four factors, those of fewer factors first.
pub(super) const ORDERS: [[usize; 4]; 11] = [
    [1, 0, 0, 0],
    [0, 1, 0, 0],
    [2, 0, 0, 0],
    [0, 0, 1, 0],
    [1, 1, 0, 0],
    [3, 0, 0, 0],
    [0, 0, 0, 1],
    [1, 0, 1, 0],
    [0, 2, 0, 0],
    [2, 1, 0, 0],
    [4, 0, 0, 0],
];

/// The factors of `A₁^{n₁} A₂^{n₂} …`, `A_m` to the power m.
pub(super) fn degree(order: &[usize; 4]) -> usize {
    (1..5).map(|m| m * order[m - 1]).sum()
}

/// Number of ways in which the factors of points are such a product: as many points are all different, and
/// set partitions of the factors have blocks of these sizes.
fn ways(count: usize, order: &[usize; 4]) -> f64 {
    let points: usize = order.iter().sum();
    let different: f64 = (0..points).map(|i| count as f64 - i as f64).product();
    let factorial = |n: usize| (1..=n).map(|i| i as f64).product::<f64>();
    let same = |m: usize| factorial(m).powi(i32::try_from(order[m - 1]).unwrap_or(0));
    let alike: f64 = (1..5).map(|m| same(m) * factorial(order[m - 1])).product();
    different * (factorial(degree(order)) / alike)
}

/// `E[X], …, E[X⁴]` of the mean X, from the values of products of every order.
pub fn of_mean<T>(count: usize, value: impl Fn(usize) -> T) -> [T; 4]
where
    T: Sum + Mul<f64, Output = T> + Div<f64, Output = T>,
{
    [1, 2, 3, 4].map(|k: i32| {
        let fits = |order: &[usize; 4]| i32::try_from(degree(order)) == Ok(k);
        let orders = ORDERS.iter().enumerate().filter(|(_, order)| fits(order));
        let sum: T = orders.map(|(i, order)| value(i) * ways(count, order)).sum();
        sum / (count as f64).powi(k)
    })
}

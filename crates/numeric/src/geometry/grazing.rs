//! Ends of rays that graze a ball, in 32 digits, for one ray or rays side by side.
//!
//! ```text
//! q = |d|²,  foot = (c − o)·d/q,  offset² = |c − o − foot d|²
//! end = foot + √((R² − offset²)/q), rounded once
//! ```

use super::Point;
use crate::Lane;
use crate::double_double::{DoubleDouble, two_prod, two_sum};

/// Distances at which the lines of rays that begin in a ball enter and leave it; its radius is neither so large nor so
/// small that a square is lost. Without a chord both are the foot.
#[inline(always)]
pub fn chord<L: Lane>(
    Point([u, v, w]): Point,
    radius: f64,
    [a, b, c]: [L; 3],
    direction: [L; 3],
) -> [L; 2] {
    let to_centre = [two_sum(a.each(u), -a), two_sum(a.each(v), -b), two_sum(a.each(w), -c)];
    let (foot, half, is_none) = foot_and_half(to_centre, a.each(radius), direction);
    let (from, to) = (foot - half, foot + half);
    let foot = (foot.high + foot.low).or_more(a.each(0.0));
    [L::select(is_none, foot, from.high + from.low), L::select(is_none, foot, to.high + to.low)]
}

/// Distance of the foot, half the chord, and where there is no chord.
#[inline(always)]
pub fn foot_and_half<L: Lane>(
    [u, v, w]: [DoubleDouble<L>; 3],
    radius: L,
    [x, y, z]: [L; 3],
) -> (DoubleDouble<L>, DoubleDouble<L>, L::Mask) {
    let square = two_prod(x, x) + two_prod(y, y) + two_prod(z, z);
    let foot = (u.times(x) + v.times(y) + w.times(z)) / square;
    let [u, v, w] = [u - foot.times(x), v - foot.times(y), w - foot.times(z)];
    let offset = u * u + v * v + w * w;
    let half = (two_prod(radius, radius) - offset) / square;
    (foot, half.root(), half.high.at_most(radius.each(0.0)))
}

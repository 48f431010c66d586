//! Ends of rays that graze a ball, in 32 digits: [`Bounds::clip`](super::Bounds::clip) for rays side by side, bit for bit.
//!
//! ```text
//! q = |d|²,  foot = (c − o)·d/q,  offset² = |c − o − foot d|²
//! end = foot + √((R² − offset²)/q), rounded once
//! ```

use super::Point;
use crate::Lane;
use crate::double_double::{two_prod, two_sum};

/// Distances at which the lines of rays that begin in a ball enter and leave it; its radius is neither so large nor so
/// small that a square is lost. Without a chord both are the foot.
#[inline(always)]
pub fn chord<L: Lane>(
    Point(centre): Point,
    radius: f64,
    [a, b, c]: [L; 3],
    direction: [L; 3],
) -> [L; 2] {
    let [x, y, z] = direction;
    let [u, v, w] = centre;
    let u = two_sum(a.each(u), -a);
    let v = two_sum(a.each(v), -b);
    let w = two_sum(a.each(w), -c);
    let square = two_prod(x, x) + two_prod(y, y) + two_prod(z, z);
    let foot = (u.times(x) + v.times(y) + w.times(z)) / square;
    let [u, v, w] = [u - foot.times(x), v - foot.times(y), w - foot.times(z)];
    let offset = u * u + v * v + w * w;
    let (radius, zero) = (a.each(radius), a.each(0.0));
    let half = (two_prod(radius, radius) - offset) / square;
    let is_none = half.high.at_most(zero);
    let half = half.root();
    let (from, to) = (foot - half, foot + half);
    let foot = (foot.high + foot.low).or_more(zero);
    [L::select(is_none, foot, from.high + from.low), L::select(is_none, foot, to.high + to.low)]
}

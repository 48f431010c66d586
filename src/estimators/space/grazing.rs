//! Where rays that graze a ball leave it, in 32 digits: [`Bounds::clip`](crate::geometry::Bounds::clip) for
//! rays side by side, bit for bit.
//!
//! ```text
//! q = |d|²,  foot = (c − o)·d/q,  offset² = |c − o − foot d|²
//! end = foot + √((R² − offset²)/q), rounded once
//! ```
//!
//! Numbers are unevaluated sums of two doubles, as in [`Wide`](crate::numeric::Wide), whose operations these
//! are, in the same order.

use crate::geometry::Point;
use crate::numeric::Lane;

/// A number of about 32 digits: `high + low`.
#[derive(Clone, Copy)]
struct Pair<L> {
    high: L,
    low: L,
}

#[inline(always)]
fn two_sum<L: Lane>(a: L, b: L) -> Pair<L> {
    let high = a + b;
    let moved = high - a;
    Pair { high, low: (a - (high - moved)) + (b - moved) }
}

#[inline(always)]
fn quick_two_sum<L: Lane>(a: L, b: L) -> Pair<L> {
    let high = a + b;
    Pair { high, low: b - (high - a) }
}

#[inline(always)]
fn two_product<L: Lane>(a: L, b: L) -> Pair<L> {
    let high = a * b;
    Pair { high, low: a.times_plus(b, -high) }
}

impl<L: Lane> Pair<L> {
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let sum = quick_two_sum(high.high, high.low + low.high);
        quick_two_sum(sum.high, sum.low + low.low)
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self.plus(Self { high: -other.high, low: -other.low })
    }

    /// Times a double.
    #[inline(always)]
    fn times(self, factor: L) -> Self {
        let product = two_product(self.high, factor);
        quick_two_sum(product.high, product.low + self.low * factor)
    }

    #[inline(always)]
    fn squared(self) -> Self {
        let product = two_product(self.high, self.high);
        let cross = self.high.times_plus(self.low, self.low * self.high);
        quick_two_sum(product.high, product.low + cross)
    }

    #[inline(always)]
    fn over(self, other: Self) -> Self {
        let first = self.high / other.high;
        let left = self.minus(other.times(first));
        let second = left.high / other.high;
        let left = left.minus(other.times(second));
        let third = left.high / other.high;
        quick_two_sum(first, second).plus(Self { high: third, low: third.each(0.0) })
    }

    /// Of a positive number.
    #[inline(always)]
    fn root(self) -> Self {
        let inverse = self.high.each(1.0) / self.high.root();
        let root = self.high * inverse;
        let left = self.minus(two_product(root, root)).high;
        two_sum(root, left * (inverse * 0.5))
    }
}

#[inline(always)]
fn sum<L: Lane>([a, b, c]: [Pair<L>; 3]) -> Pair<L> {
    a.plus(b).plus(c)
}

/// Where the lines of rays that begin in a ball enter and leave it; its radius is neither so large nor so
/// small that a square is lost. Without a chord both are the foot.
#[inline(always)]
pub fn chord<L: Lane>(
    Point(centre): Point,
    radius: f64,
    [a, b, c]: [L; 3],
    direction: [L; 3],
) -> [L; 2] {
    let [x, y, z] = direction;
    let [u, v, w] = centre.map(
        #[inline(always)]
        |centre| a.each(centre),
    );
    let to_centre = [two_sum(u, -a), two_sum(v, -b), two_sum(w, -c)];
    let [u, v, w] = to_centre;
    let square = sum([two_product(x, x), two_product(y, y), two_product(z, z)]);
    let foot = sum([u.times(x), v.times(y), w.times(z)]).over(square);
    let aside = [u.minus(foot.times(x)), v.minus(foot.times(y)), w.minus(foot.times(z))];
    let [u, v, w] = aside;
    let offset = sum([u.squared(), v.squared(), w.squared()]);
    let (radius, zero) = (a.each(radius), a.each(0.0));
    let half = two_product(radius, radius).minus(offset).over(square);
    let is_none = half.high.at_most(zero);
    let half = half.root();
    let (from, to) = (foot.minus(half), foot.plus(half));
    let foot = (foot.high + foot.low).or_more(zero);
    [from, to].map(
        #[inline(always)]
        |end| L::select(is_none, foot, end.high + end.low),
    )
}

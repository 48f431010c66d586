//! Places and directions in space, and frames about directions, in either precision.

use std::f64::consts::TAU;

use super::precision::Precision;

/// Three numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place<P>(pub [P; 3]);

impl<P: Precision> Place<P> {
    /// Of constants.
    pub fn of(numbers: [f64; 3]) -> Self {
        Self(numbers.map(P::of))
    }

    fn with(self, other: Self, f: impl Fn(P, P) -> P) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([f(a, x), f(b, y), f(c, z)])
    }

    /// `self + other·factor`.
    #[inline(always)]
    pub fn plus(self, other: Self, factor: P) -> Self {
        self.with(other, |a, x| a + x * factor)
    }

    /// `self − other`.
    #[inline(always)]
    pub fn less(self, other: Self) -> Self {
        self.with(other, |a, x| a - x)
    }

    /// `self·factor`.
    #[inline(always)]
    pub fn times(self, factor: P) -> Self {
        Self(self.0.map(|a| a * factor))
    }

    /// The scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> P {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    /// The direction at an angle of the given cosine from this one, at an azimuth in turns: as
    /// [`turned`](numeric::geometry::frame::turned).
    #[inline(always)]
    pub fn turned(self, cosine: P, turns: P) -> Self {
        let (zero, one) = (P::of(0.0), P::of(1.0));
        let angle = turns * TAU;
        let sine = ((one - cosine) * (one + cosine)).or_more(zero).root();
        let [x, y, z] = self.0;
        let sign = P::select(z.below(zero), -one, one);
        let a = -one / (sign + z);
        let b = x * y * a;
        let first = Self([one + sign * x * x * a, sign * b, -(sign * x)]);
        let second = Self([b, sign + y * y * a, -y]);
        let turned = self.times(cosine).plus(first, sine * angle.cos());
        let turned = turned.plus(second, sine * angle.sin());
        turned.times(P::of(1.5) - turned.dot(turned) * 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::Narrow as F32;
    use numeric::geometry::{Point, frame};

    #[test]
    fn both_precisions_turn_as_walks_do() {
        for (d, cosine, turns) in [
            ([0.0, 0.0, 1.0], 0.3, 0.1),
            ([0.6, 0.0, -0.8], -0.7, 0.6),
            ([0.48, 0.6, 0.64], 1.0, 0.9),
        ] {
            let there = frame::turned(Point(d), cosine, turns).0;
            let double = Place(d).turned(cosine, turns).0;
            let narrow = Place::<F32>::of(d).turned(F32::of(cosine), F32::of(turns)).0;
            for i in 0..3 {
                assert!((double[i] - there[i]).abs() < 1e-15, "{double:?} {there:?}");
                assert!((narrow[i].double() - there[i]).abs() < 1e-6, "{narrow:?} {there:?}");
            }
        }
    }
}

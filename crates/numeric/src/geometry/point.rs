//! Points and directions in three dimensions.

use std::ops::{Add, Mul, Sub};

use crate::Lane;

/// A point, or a vector, in units of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point(pub [f64; 3]);

impl Point {
    /// Scalar product.
    #[inline]
    pub fn dot(self, other: Self) -> f64 {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    /// Returns the point in every element of a lane.
    #[inline(always)]
    pub fn each<L: Lane>(self, like: L) -> [L; 3] {
        let Self([x, y, z]) = self;
        [like.each(x), like.each(y), like.each(z)]
    }

    /// Scalar product with points side by side.
    #[inline(always)]
    pub fn along<L: Lane>(self, [x, y, z]: [L; 3]) -> L {
        x * self.0[0] + y * self.0[1] + z * self.0[2]
    }

    /// The squared distance from points side by side, in units of which a scale is the inverse.
    #[inline(always)]
    pub fn square_to<L: Lane>(self, [x, y, z]: [L; 3], scale: f64) -> L {
        let [x, y, z] = [(x - self.0[0]) * scale, (y - self.0[1]) * scale, (z - self.0[2]) * scale];
        x * x + y * y + z * z
    }

    /// Vector product.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// Euclidean length.
    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// The vector of length 1 in the same direction, scaled so that neither very long nor very
    /// short vectors overflow; `None` for the zero vector and for infinite ones.
    pub fn normalised(self) -> Option<Self> {
        let largest = self.0.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        if largest <= 0.0 || !largest.is_finite() {
            return None;
        }
        let scaled = self * (1.0 / largest);
        Some(scaled * (1.0 / scaled.norm()))
    }
}

impl Add for Point {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self([self.0[0] + o.0[0], self.0[1] + o.0[1], self.0[2] + o.0[2]])
    }
}

impl Sub for Point {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self([self.0[0] - o.0[0], self.0[1] - o.0[1], self.0[2] - o.0[2]])
    }
}

impl Mul<f64> for Point {
    type Output = Self;
    #[inline]
    fn mul(self, k: f64) -> Self {
        Self([self.0[0] * k, self.0[1] * k, self.0[2] * k])
    }
}

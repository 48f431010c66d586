//! A ray of finite length.

use super::Point;
use crate::Span;

/// `p(t) = origin + t·direction`, `t ∈ [0, length]`, `|direction| = 1`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Point at `t = 0`.
    pub origin: Point,
    /// Unit vector.
    pub direction: Point,
    /// Length, ≥ 0.
    pub length: f64,
}

impl Ray {
    /// A ray along `direction`, which need not have length 1; `None` if it has no direction.
    pub fn new(origin: Point, direction: Point, length: f64) -> Option<Self> {
        let direction = direction.normalised()?;
        Some(Self { origin, direction, length })
    }

    /// The point at distance `t`.
    #[inline]
    pub fn at(&self, t: f64) -> Point {
        self.origin + self.direction * t
    }

    /// Returns the distance t of the point on the ray's line that is nearest to a point, and the vector from there to
    /// it.
    pub fn nearest_to(&self, point: Point) -> (f64, Point) {
        let to_point = point - self.origin;
        let foot = to_point.dot(self.direction);
        (foot, to_point - self.direction * foot)
    }

    /// `[0, length]`.
    pub fn span(&self) -> Span {
        Span::new(0.0, self.length)
    }
}

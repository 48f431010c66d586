//! The bodies that bound a medium, and where a ray is inside them.

use super::{Point, Ray};
use crate::numeric::Span;

/// A box with its faces along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub low: Point,
    /// The corner with the largest coordinates.
    pub high: Point,
}

impl Aabb {
    /// The point of the box that is nearest to `p`.
    #[must_use]
    pub fn nearest(&self, p: Point) -> Point {
        Point(std::array::from_fn(|i| p.0[i].max(self.low.0[i]).min(self.high.0[i])))
    }

    /// The values that `p·direction` takes in the box.
    #[must_use]
    pub fn reach(&self, direction: Point) -> Span {
        (0..3).fold(Span::empty(0.0), |reach, i| {
            let (a, b) = (self.low.0[i] * direction.0[i], self.high.0[i] * direction.0[i]);
            Span::new(reach.from + a.min(b), reach.to + a.max(b))
        })
    }

    /// The part shared with another box; `None` where they do not meet.
    #[must_use]
    pub fn intersect(&self, other: &Self) -> Option<Self> {
        let low: [f64; 3] = std::array::from_fn(|i| self.low.0[i].max(other.low.0[i]));
        let high: [f64; 3] = std::array::from_fn(|i| self.high.0[i].min(other.high.0[i]));
        (0..3).all(|i| low[i] <= high[i]).then_some(Self { low: Point(low), high: Point(high) })
    }
}

/// Where a volume may be non-zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bounds {
    /// All of space.
    Everywhere,
    /// A ball.
    Sphere {
        /// Its centre.
        centre: Point,
        /// Its radius, > 0.
        radius: f64,
    },
    /// A box.
    Box(Aabb),
}

impl Bounds {
    /// The stretch of the ray that is inside: empty for a ray that misses or only grazes, from 0
    /// for one that starts inside.
    #[must_use]
    pub fn clip(&self, ray: &Ray) -> Span {
        match self {
            Self::Everywhere => ray.span(),
            Self::Sphere { centre, radius } => clip_sphere(*centre, *radius, ray),
            Self::Box(bounds) => clip_box(bounds, ray),
        }
    }

    /// Whether the point is inside or on the boundary.
    #[must_use]
    pub fn contains(&self, p: Point) -> bool {
        match self {
            Self::Everywhere => true,
            Self::Sphere { centre, radius } => (p - *centre).norm() <= *radius,
            Self::Box(bounds) => bounds.nearest(p) == p,
        }
    }

    /// The volume of the body, length³; infinite for all of space.
    #[must_use]
    pub fn content(&self) -> f64 {
        match self {
            Self::Everywhere => f64::INFINITY,
            Self::Sphere { radius, .. } => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
            Self::Box(bounds) => (bounds.high - bounds.low).0.iter().product(),
        }
    }

    /// The area of its boundary, length²; `None` for all of space, which has none.
    #[must_use]
    pub fn surface(&self) -> Option<f64> {
        match self {
            Self::Everywhere => None,
            Self::Sphere { radius, .. } => Some(4.0 * std::f64::consts::PI * radius * radius),
            Self::Box(bounds) => {
                let [a, b, c] = (bounds.high - bounds.low).0;
                Some(2.0 * (a * b + b * c + c * a))
            }
        }
    }

    /// The smallest box around the body; `None` for all of space.
    #[must_use]
    pub fn enclosing_box(&self) -> Option<Aabb> {
        match self {
            Self::Everywhere => None,
            Self::Sphere { centre, radius } => {
                let reach = Point([*radius; 3]);
                Some(Aabb { low: *centre - reach, high: *centre + reach })
            }
            Self::Box(bounds) => Some(*bounds),
        }
    }
}

/// `|o + td − c| ≤ R`. The squared distance of the ray's line from the centre is taken from the
/// residual vector, not from `|o−c|² − ((o−c)·d)²`, which cancels for far origins.
fn clip_sphere(centre: Point, radius: f64, ray: &Ray) -> Span {
    let to_centre = centre - ray.origin;
    let foot = to_centre.dot(ray.direction);
    let offset = (to_centre - ray.direction * foot).norm();
    if offset >= radius {
        return Span::empty(foot.clamp(0.0, ray.length));
    }
    let half = ((radius - offset) * (radius + offset)).sqrt();
    Span::new(foot - half, foot + half).intersect(ray.span())
}

fn clip_box(bounds: &Aabb, ray: &Ray) -> Span {
    let mut span = ray.span();
    for axis in 0..3 {
        let (o, d) = (ray.origin.0[axis], ray.direction.0[axis]);
        let (low, high) = (bounds.low.0[axis], bounds.high.0[axis]);
        if d == 0.0 {
            // A ray within a face is inside, as its neighbours on one side are.
            if o < low || o > high {
                return Span::empty(span.from);
            }
            continue;
        }
        let (a, b) = ((low - o) / d, (high - o) / d);
        span = span.intersect(Span::new(a.min(b), a.max(b)));
        if span.is_empty() {
            return span;
        }
    }
    span
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ray(origin: [f64; 3], direction: [f64; 3], length: f64) -> Ray {
        Ray::new(Point(origin), Point(direction), length).expect("a direction")
    }

    #[test]
    fn a_ray_misses_grazes_starts_inside_or_crosses_a_sphere() {
        let sphere = Bounds::Sphere { centre: Point([0.0, 0.0, 10.0]), radius: 10.0 };
        assert_eq!(sphere.clip(&ray([0.0; 3], [0.0, 0.0, 1.0], 30.0)), Span::new(0.0, 20.0));
        assert!(sphere.clip(&ray([0.0, 11.0, 0.0], [0.0, 0.0, 1.0], 30.0)).is_empty());
        assert!(sphere.clip(&ray([0.0, 10.0, 0.0], [0.0, 0.0, 1.0], 30.0)).is_empty());
        let inside = sphere.clip(&ray([0.0, 0.0, 10.0], [1.0, 0.0, 0.0], 30.0));
        assert_eq!(inside, Span::new(0.0, 10.0));
        assert!(sphere.clip(&ray([0.0, 0.0, 10.0], [1.0, 0.0, 0.0], 0.0)).is_empty());
    }

    #[test]
    fn a_ray_is_clipped_to_a_box() {
        let cube = Bounds::Box(Aabb { low: Point([0.0; 3]), high: Point([1.0; 3]) });
        assert_eq!(cube.clip(&ray([0.5, 0.5, -1.0], [0.0, 0.0, 2.0], 9.0)), Span::new(1.0, 2.0));
        assert!(cube.clip(&ray([0.5, 2.0, -1.0], [0.0, 0.0, 1.0], 9.0)).is_empty());
        assert!(cube.clip(&ray([0.5, 0.5, 3.0], [0.0, 0.0, 1.0], 9.0)).is_empty());
    }

    #[test]
    fn bodies_have_content_and_surface() {
        let cuboid = Bounds::Box(Aabb { low: Point([0.0; 3]), high: Point([1.0, 2.0, 3.0]) });
        assert_eq!((cuboid.content(), cuboid.surface()), (6.0, Some(22.0)));
        let ball = Bounds::Sphere { centre: Point([1.0; 3]), radius: 3.0 };
        // The mean chord 4V/S of a ball is 4R/3.
        assert!((4.0 * ball.content() / ball.surface().expect("bounded") - 4.0).abs() < 1e-15);
        assert_eq!(Bounds::Everywhere.surface(), None);
    }

    #[test]
    fn a_box_reaches_between_its_corners() {
        let cube = Aabb { low: Point([0.0, -1.0, 2.0]), high: Point([1.0, 1.0, 3.0]) };
        assert_eq!(cube.reach(Point([2.0, -1.0, 1.0])), Span::new(1.0, 6.0));
    }
}

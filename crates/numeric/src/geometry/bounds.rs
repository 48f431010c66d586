//! The bodies that bound a medium, and where a ray is inside them.

use super::{Point, Ray, grazing};
use crate::double_double::{DoubleDouble, two_sum};
use crate::{Known, Lane, Span};

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
    pub fn nearest(&self, p: Point) -> Point {
        Point(std::array::from_fn(|i| p.0[i].max(self.low.0[i]).min(self.high.0[i])))
    }

    /// The values that `p·direction` takes in the box.
    pub fn reach(&self, direction: Point) -> Span {
        (0..3).fold(Span::empty(0.0), |reach, i| {
            let (a, b) = (self.low.0[i] * direction.0[i], self.high.0[i] * direction.0[i]);
            Span::new(reach.from + a.min(b), reach.to + a.max(b))
        })
    }

    /// The part shared with another box; `None` where they do not meet.
    pub fn intersect(&self, other: &Self) -> Option<Self> {
        let low: [f64; 3] = std::array::from_fn(|i| self.low.0[i].max(other.low.0[i]));
        let high: [f64; 3] = std::array::from_fn(|i| self.high.0[i].min(other.high.0[i]));
        (0..3).all(|i| low[i] <= high[i]).then_some(Self { low: Point(low), high: Point(high) })
    }
}

/// Region outside which a volume is zero.
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
    /// Stretch of the ray that is inside: empty for a ray that misses or only grazes, from 0
    /// for one that starts inside.
    pub fn clip(&self, ray: &Ray) -> Span {
        match self {
            Self::Everywhere => ray.span(),
            Self::Sphere { centre, radius } => clip_sphere(*centre, *radius, ray),
            Self::Box(bounds) => clip_box(bounds, ray),
        }
    }

    /// Ends of the stretch of the ray inside, with bounds on their errors: 0 where the ray itself begins or ends.
    pub fn ends(&self, ray: &Ray) -> [Known; 2] {
        let inside = self.clip(ray);
        let roundings = match self {
            Self::Sphere { centre, radius } => {
                let (_, offset) = ray.nearest_to(*centre);
                if is_plain(*centre, *radius, ray, offset.norm()) { 64.0 * radius } else { 0.0 }
            }
            _ => 0.0,
        };
        [(inside.from, 0.0), (inside.to, ray.length)].map(|(end, own)| {
            let error = f64::EPSILON * (roundings + 2.0 * end.abs());
            Known::new(end, if end == own { 0.0 } else { error })
        })
    }

    /// Length of the longest straight line inside.
    pub fn diameter(&self) -> f64 {
        match self {
            Self::Everywhere => f64::INFINITY,
            Self::Sphere { radius, .. } => 2.0 * radius,
            Self::Box(within) => (within.high - within.low).norm(),
        }
    }

    /// Mask of the points in a lane that are in the body or on its boundary.
    #[inline(always)]
    pub fn contains<L: Lane>(&self, p: [L; 3]) -> L::Mask {
        let zero = p[0].each(0.0);
        match self {
            Self::Everywhere => zero.at_most(zero),
            Self::Sphere { centre, radius } => {
                centre.square_to(p, 1.0).root().at_most(zero.each(*radius))
            }
            Self::Box(Aabb { low, high }) => {
                let mut inside = zero.at_most(zero);
                for (axis, &x) in p.iter().enumerate() {
                    let (low, high) = (zero.each(low.0[axis]), zero.each(high.0[axis]));
                    inside = inside & low.at_most(x) & x.at_most(high);
                }
                inside
            }
        }
    }

    /// The volume of the body, length³; infinite for all of space.
    pub fn content(&self) -> f64 {
        match self {
            Self::Everywhere => f64::INFINITY,
            Self::Sphere { radius, .. } => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
            Self::Box(bounds) => (bounds.high - bounds.low).0.iter().product(),
        }
    }

    /// The area of its boundary, length²; `None` for all of space, which has none.
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

/// Returns whether plain doubles find the ends of a chord to 64 roundings of the radius: the origin is near
/// and the ray does not graze.
fn is_plain(centre: Point, radius: f64, ray: &Ray, offset: f64) -> bool {
    offset < 0.9 * radius && (centre - ray.origin).norm() < 4.0 * radius && radius > 1e-100
}

/// `|o + td − c| ≤ R`. The squared distance of the ray's line from the centre is taken from the
/// residual vector, not from `|o−c|² − ((o−c)·d)²`, which cancels for far origins.
fn clip_sphere(centre: Point, radius: f64, ray: &Ray) -> Span {
    let (foot, offset) = ray.nearest_to(centre);
    let offset = offset.norm();
    if !is_plain(centre, radius, ray, offset) {
        return clip_sphere_exactly(centre, radius, ray);
    }
    let half = ((radius - offset) * (radius + offset)).sqrt();
    Span::new(foot - half, foot + half).intersect(ray.span())
}

/// The chord of a ray with a far origin, or of a grazing ray, in 32 digits and rounded once. Doubles lose it.
fn clip_sphere_exactly(centre: Point, radius: f64, ray: &Ray) -> Span {
    let distances = (0..3).map(|i| (centre.0[i] - ray.origin.0[i]).abs());
    let largest = distances.fold(radius, f64::max);
    // A power of two, so that squares neither overflow nor underflow and nothing is rounded.
    let power = -largest.log2().floor();
    if !power.is_finite() {
        return Span::empty(0.0);
    }
    #[allow(clippy::cast_possible_truncation)] // an exponent
    let power = power as i32;
    let to_centre = [0, 1, 2].map(|i| two_sum(centre.0[i], -ray.origin.0[i]).scaled(power));
    let radius = DoubleDouble::from(radius).scaled(power).high;
    let (foot, half, is_none) = grazing::foot_and_half(to_centre, radius, ray.direction.0);
    let end = |at: DoubleDouble| at.scaled(-power).value();
    if is_none {
        return Span::empty(end(foot).clamp(0.0, ray.length));
    }
    Span::new(end(foot - half), end(foot + half)).intersect(ray.span())
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
    fn points_on_faces_are_inside() {
        let low = Point([-1.0, 0.0, 2.0]);
        let bodies = [
            Bounds::Everywhere,
            Bounds::Sphere { centre: Point([0.5, 1.0, 2.0]), radius: 1.5 },
            Bounds::Box(Aabb { low, high: Point([2.0, 1.0, 3.0]) }),
        ];
        let contains = |body: Bounds, p: Point| match body {
            Bounds::Everywhere => true,
            Bounds::Sphere { centre, radius } => (p - centre).norm() <= radius,
            Bounds::Box(within) => within.nearest(p) == p,
        };
        let mut inside = [0; 3];
        for n in 0..1000 {
            // Halves: many are on a face.
            let at = |slope: f64, low: f64, steps: f64| {
                low + 0.5 * (steps * (f64::from(n) * slope).fract()).floor()
            };
            let p = [at(0.618, -1.5, 9.0), at(0.414, -0.5, 5.0), at(0.732, 1.0, 6.0)];
            for (count, body) in inside.iter_mut().zip(bodies) {
                assert_eq!(body.contains(p), contains(body, Point(p)), "{body:?} {p:?}");
                *count += i32::from(body.contains(p));
            }
        }
        assert!(inside[0] == 1000 && inside[1..].iter().all(|n| (50..950).contains(n)));
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
    fn a_ray_that_grazes_from_afar_keeps_its_chord() {
        // |y| = 1 − 2⁻⁴⁰ at 2²⁰ radii: half a chord of √(2⁻³⁹ − 2⁻⁸⁰).
        let sphere = Bounds::Sphere { centre: Point([0.0; 3]), radius: 1.0 };
        let far = 2f64.powi(20);
        let grazing = ray([-far, 1.0 - 2f64.powi(-40), 0.0], [1.0, 0.0, 0.0], 4e6);
        let inside = sphere.clip(&grazing);
        let half = (2f64.powi(-39) - 2f64.powi(-80)).sqrt();
        assert!((0.5 * inside.length() / half - 1.0).abs() < far * f64::EPSILON / half);
        let [from, to] = sphere.ends(&grazing);
        assert!((from.value - (far - half)).abs() <= from.error && from.error < 1e-9);
        assert!((to.value - (far + half)).abs() <= to.error);
        // Numbers whose squares are none.
        let large = Bounds::Sphere { centre: Point([0.0; 3]), radius: 1e200 };
        assert!(
            (large.clip(&ray([-1e201, 0.0, 0.0], [1.0, 0.0, 0.0], 1e202)).length() / 2e200 - 1.0)
                .abs()
                < 1e-14
        );
        let small = Bounds::Sphere { centre: Point([0.0; 3]), radius: 1e-200 };
        assert!(
            (small.clip(&ray([-1e-199, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0)).length() / 2e-200 - 1.0)
                .abs()
                < 1e-14
        );
        let nowhere = ray([f64::MAX, 0.0, 0.0], [1.0, 0.0, 0.0], 1.0);
        let away = Bounds::Sphere { centre: Point([-f64::MAX; 3]), radius: 1.0 };
        assert!(away.clip(&nowhere).is_empty());
    }

    #[test]
    fn the_ends_of_the_ray_itself_are_exact() {
        let sphere = Bounds::Sphere { centre: Point([0.0; 3]), radius: 1.0 };
        let [from, to] = sphere.ends(&ray([0.0; 3], [0.0, 0.0, 1.0], 3.0));
        assert_eq!((from.value, from.error), (0.0, 0.0));
        assert!((to.value - 1.0).abs() < 1e-15 && to.error > 0.0 && to.error < 1e-13);
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

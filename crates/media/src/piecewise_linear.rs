//! Layers of linearly varying extinction.
//!
//! ```text
//! σ_t(x) = the straight line through (knotsᵢ, valuesᵢ) and (knotsᵢ₊₁, valuesᵢ₊₁)
//! ```
//!
//! In 1-D `x` is the distance `t`; in 3-D it is the height `p·axis` of a plane-parallel medium.
//! Outside the knots the field keeps the first and the last value.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `knots` | ascending, two or more | length | required |
//! | `values` | σ_t ≥ 0 at each knot | 1/length | required |
//! | `axis` | 3-D only: the direction of `x`; it is normalised | | `[0, 0, 1]` |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Optical depth and free flight are closed forms.

use super::{Field, Piecewise, Smoothness, body};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Lane, Span};

/// A plane-parallel volume of linearly varying layers: one value at every knot.
pub type PiecewiseLinear = Layers<false>;

/// Reads `values` between every two `breaks`, or at every one of `knots`.
pub fn read_pieces(settings: &Settings, is_steps: bool) -> Option<Piecewise> {
    let (key, one, at, fewest) =
        if is_steps { ("breaks", "break", "between", 1) } else { ("knots", "knot", "at", 2) };
    let places = settings.numbers(key, Domain::Finite, 2);
    let values = settings.numbers("values", Domain::NonNegative, fewest);
    let (places, values) = (places?, values?);
    if places.windows(2).any(|ends| ends[0] >= ends[1]) {
        let help = format!("each {one} is above the one before");
        settings.fault(key, format!("`{key}` do not ascend"), help);
        return None;
    }
    if values.len() + usize::from(is_steps) != places.len() {
        let message = format!("{} values stand {at} {} {key}", values.len(), places.len());
        let every = if is_steps { "every two breaks" } else { "every knot" };
        settings.fault("values", message, format!("there is one value {at} {every}"));
        return None;
    }
    Some(if is_steps {
        Piecewise::steps(&places, &values)
    } else {
        Piecewise::lines(&places, &values)
    })
}

/// A plane-parallel volume: straight pieces along an axis; constant ones if they are steps.
pub struct Layers<const STEPS: bool> {
    pieces: Piecewise,
    axis: Point,
    bounds: Bounds,
}

impl<const STEPS: bool> Layers<STEPS> {
    /// Layers by pieces of the height along an axis of length 1.
    pub fn new(pieces: Piecewise, axis: Point, bounds: Bounds) -> Self {
        Self { pieces, axis, bounds }
    }
}

impl<const STEPS: bool> Field for Layers<STEPS> {
    type Profile = Piecewise;

    const EXTINCTIONS: &'static [&'static str] = &["values"];

    fn line(settings: &Settings) -> Option<Piecewise> {
        read_pieces(settings, STEPS)
    }

    fn volume(settings: &Settings) -> Option<Self> {
        let pieces = read_pieces(settings, STEPS);
        let axis = body::read_axis(settings);
        let bounds = body::read_bounds(settings);
        Some(Self { pieces: pieces?, axis: axis?, bounds: bounds? })
    }

    fn smoothness(&self) -> Smoothness {
        Smoothness::Layers
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }

    #[inline(always)]
    fn extinction_at<L: Lane>(&self, p: [L; 3]) -> L {
        self.pieces.value(self.axis.along(p))
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        let span = within.reach(self.axis);
        self.pieces.on(span).corner_values().fold(0.0, f64::max)
    }

    /// The pieces along the ray: heights `p·axis` become distances.
    fn along(&self, ray: &Ray, inside: Span) -> Piecewise {
        let (height, climb) = (ray.origin.dot(self.axis), ray.direction.dot(self.axis));
        // A ray that climbs by less than rounding over its length stays in its layer.
        if (climb * ray.length).abs() <= f64::EPSILON * height.abs().max(f64::MIN_POSITIVE) {
            return Piecewise::constant(self.pieces.value(height), inside);
        }
        let crossings = self.pieces.knots().iter().map(|knot| (knot - height) / climb);
        let crossings = inside.cut(crossings.collect());
        if crossings.len() < 2 {
            return Piecewise::constant(self.pieces.value(height + climb * inside.from), inside);
        }
        // Two lookups inside each piece determine its line, away from the jumps at its ends.
        let ends = crossings.windows(2).map(|piece| {
            let at = |u: f64| {
                let t = piece[0] + u * (piece[1] - piece[0]);
                self.pieces.value(height + climb * t)
            };
            let (a, b) = (at(0.25), at(0.75));
            (1.5 * a - 0.5 * b, 1.5 * b - 0.5 * a)
        });
        Piecewise::joined(&crossings, ends)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn upright(pieces: Piecewise) -> Layers<false> {
        let (axis, bounds) = (Point([0.0, 0.0, 1.0]), Bounds::Everywhere);
        Layers { pieces, axis, bounds }
    }
    use crate::OpticalDepth;

    #[test]
    fn an_oblique_ray_sees_the_layers_stretched() {
        let pieces = Piecewise::lines(&[0.0, 1.0, 2.5, 4.0], &[0.2, 1.5, 0.4, 0.9]);
        let depth = pieces.optical_depth(Span::new(0.3, 3.7)).value;
        let layers = upright(pieces);
        let (origin, direction) = (Point([5.0, 1.0, 3.7]), Point([0.6, 0.0, -0.8]));
        let ray = Ray::new(origin, direction, 3.4 / 0.8).expect("a direction");
        let seen = layers.along(&ray, ray.span()).optical_depth(ray.span()).value;
        assert!((seen - depth / 0.8).abs() < 1e-14);
    }

    #[test]
    fn a_level_ray_stays_in_its_layer() {
        let pieces = Piecewise::steps(&[0.0, 1.0, 2.0], &[0.5, 3.0]);
        let layers = upright(pieces);
        let ray = Ray::new(Point([0.0, 0.0, 0.5]), Point([1.0, 0.0, 0.0]), 2.0).expect("direction");
        let seen = layers.along(&ray, ray.span()).optical_depth(ray.span()).value;
        assert!((seen - 1.0).abs() < 1e-15);
    }
}

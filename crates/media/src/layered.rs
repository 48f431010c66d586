//! Fields of one coordinate, written once: a medium along a line, and plane-parallel layers in space.
//!
//! ```text
//! 1-D:  σ_t(t) = value(t)
//! 3-D:  σ_t(p) = value(p·axis),   along a ray  value(x₀ + x₁ t),  x₀ = origin·axis,  x₁ = direction·axis
//! ```

use std::sync::Arc;

use super::body::{read_axis, read_bounds};
use super::{Extinction, Facts, Field, OpticalDepth, Profile, Reader, profile};
use crate::catalogue::Settings;
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span};

/// A field of one coordinate: the distance along a line, or the height `p·axis` in space.
///
/// Four functions make a medium of both kinds; the others have defaults. [`super::Reader::layered`] reads it. The
/// manual's page on media of your own (`docs/extending.md`) has an example in 30 lines.
pub trait Stratified: Sized + Clone + Send + Sync + 'static {
    /// Settings to which σ_t is proportional, all together: sweeps of the density and of the contrast change these.
    const EXTINCTIONS: &'static [&'static str] = &[];

    /// True if volumes have an `axis`.
    const HAS_AXIS: bool = true;

    /// Reads the settings of `medium.NAME = { … }` and of `volume.NAME = { … }`, without `axis` and `bounds`.
    fn read(settings: &Settings) -> Option<Self>;

    /// `σ_t(x) ≥ 0` in 1/length, as one formula for every lane type.
    fn value<L: Lane>(&self, x: L) -> L;

    /// `∫ σ_t dx` with a bound on its own error.
    fn integral(&self, x: Span) -> Known;

    /// An upper bound of `σ_t` on an interval, also of rounded lookups.
    fn highest(&self, x: Span) -> f64;

    /// The `x` up to which the integral is `depth`; `None` where the interval ends first.
    ///
    /// The default brackets the root of the integral.
    fn inverse(&self, x: Span, depth: f64) -> Option<f64> {
        profile::free_flight_by_root(self, x, depth)
    }

    /// All jumps and kinks inside an interval, and places about features that quadrature would otherwise miss. Places
    /// outside are ignored.
    fn features(&self, x: Span) -> Vec<f64> {
        let _ = x;
        Vec::new()
    }

    /// Optional facts.
    fn facts(&self) -> Facts<'_> {
        Facts::default()
    }

    /// The field as a function of the distance along a ray, if it is one of the same type.
    fn along(&self, heights: &Heights, inside: Span) -> Option<Self> {
        let _ = (heights, inside);
        None
    }

    /// Reader of media and volumes, for the list of pages.
    fn reader() -> Reader {
        Reader::layered::<Self>()
    }
}

impl<P: Stratified> Extinction for P {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        self.value(t)
    }

    fn facts(&self) -> Facts<'_> {
        Stratified::facts(self)
    }
}

impl<P: Stratified> OpticalDepth for P {
    fn optical_depth(&self, span: Span) -> Known {
        self.integral(span)
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        self.features(span)
    }

    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        self.inverse(span, depth)
    }
}

/// Heights along a ray: `x = start + slope · t`.
#[derive(Debug, Clone, Copy)]
pub struct Heights {
    /// Height of the origin.
    pub start: f64,
    /// Change per unit of length.
    pub slope: f64,
    length: f64,
}

impl Heights {
    /// The height at a distance.
    #[inline(always)]
    pub fn at<L: Lane>(&self, t: L) -> L {
        t * self.slope + self.start
    }

    /// Returns whether the ray climbs by less than rounding over its length.
    pub fn is_level(&self) -> bool {
        (self.slope * self.length).abs() <= f64::EPSILON * self.start.abs().max(f64::MIN_POSITIVE)
    }
}

/// A plane-parallel volume: a field of the height `p·axis` within bounds.
pub struct Layered<P> {
    field: P,
    axis: Point,
    bounds: Bounds,
}

impl<P: Stratified> Layered<P> {
    /// A volume of layers across an axis of length 1.
    pub fn new(field: P, axis: Point, bounds: Bounds) -> Self {
        Self { field, axis, bounds }
    }

    /// Reads the settings of the field, `axis` and `bounds`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let field = P::read(settings);
        let axis = if P::HAS_AXIS { read_axis(settings) } else { Some(Point([0.0, 0.0, 1.0])) };
        let bounds = read_bounds(settings);
        Some(Self { field: field?, axis: axis?, bounds: bounds? })
    }
}

impl<P: Stratified> Field for Layered<P> {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        self.field.value(self.axis.along(p))
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        self.field.highest(within.reach(self.axis))
    }

    fn along(&self, ray: &Ray, inside: Span) -> Arc<Profile> {
        let (start, slope) = (ray.origin.dot(self.axis), ray.direction.dot(self.axis));
        let heights = Heights { start, slope, length: ray.length };
        match self.field.along(&heights, inside) {
            Some(field) => Arc::new(field),
            None => Arc::new(OnRay { field: self.field.clone(), heights }),
        }
    }

    fn facts(&self) -> Facts<'_> {
        let facts = Stratified::facts(&self.field);
        let is_ball = matches!(self.bounds, Bounds::Sphere { .. });
        Facts { is_radial: is_ball && facts.single_value.is_some(), ..facts }
    }
}

/// A field of the height along a ray.
struct OnRay<P> {
    field: P,
    heights: Heights,
}

impl<P: Stratified> OnRay<P> {
    /// The heights of an interval, in ascending order.
    fn reach(&self, span: Span) -> Span {
        let [from, to] = [span.from, span.to].map(|t| self.heights.at(t));
        Span::new(from.min(to), from.max(to))
    }
}

impl<P: Stratified> Extinction for OnRay<P> {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        self.field.value(self.heights.at(t))
    }

    fn facts(&self) -> Facts<'_> {
        let facts = Stratified::facts(&self.field);
        let pieces_per_length = facts.pieces_per_length * self.heights.slope.abs();
        Facts { pieces_per_length, has_inverse: false, ..facts }
    }
}

impl<P: Stratified> OpticalDepth for OnRay<P> {
    fn optical_depth(&self, span: Span) -> Known {
        let Heights { start, slope, .. } = self.heights;
        // Rounding moves a height by this.
        let moved = |t: f64| 2.0 * f64::EPSILON * (start.abs() + (slope * t).abs());
        if self.heights.is_level() {
            let (value, length, moved) = (self.field.value(start), span.length(), moved(span.to));
            let change = |x: f64| (self.field.value(x) - value).abs();
            let error = change(start - moved) + change(start + moved) + f64::EPSILON * value;
            return Known::new(value * length, error * length);
        }
        let depth = self.field.integral(self.reach(span));
        let ends = [span.from, span.to].map(|t| {
            let (x, moved) = (self.heights.at(t), moved(t));
            moved * self.field.highest(Span::new(x - moved, x + moved))
        });
        let error = depth.error + ends[0] + ends[1] + 4.0 * f64::EPSILON * depth.value;
        Known::new(depth.value / slope.abs(), error / slope.abs())
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        if self.heights.is_level() {
            return Vec::new();
        }
        let Heights { start, slope, .. } = self.heights;
        let at = self.field.features(self.reach(span)).into_iter().map(|x| (x - start) / slope);
        at.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exponential::Exponential;

    /// An exponential atmosphere with no more than four functions.
    #[derive(Clone)]
    struct Atmosphere;

    impl Stratified for Atmosphere {
        fn read(_: &Settings) -> Option<Self> {
            Some(Self)
        }

        fn value<L: Lane>(&self, x: L) -> L {
            (x * -0.5).exp() * 3.0
        }

        fn integral(&self, x: Span) -> Known {
            Known::exact(6.0 * ((-0.5 * x.from).exp() - (-0.5 * x.to).exp()))
        }

        fn highest(&self, x: Span) -> f64 {
            self.value(x.from) * (1.0 + 1e-12)
        }

        fn features(&self, _: Span) -> Vec<f64> {
            vec![1.0]
        }
    }

    #[test]
    fn four_functions_make_a_volume() {
        let axis = Point([0.6, 0.0, 0.8]);
        let own = Layered::new(Atmosphere, axis, Bounds::Everywhere);
        let built_in = Layered::new(Exponential::new(3.0, 0.5), axis, Bounds::Everywhere);
        let (origin, part) = (Point([0.3, -1.0, 2.0]), Span::new(0.5, 3.0));
        for direction in [[0.0, 0.0, 1.0], [1.0, 2.0, -2.0], [-0.6, 0.0, -0.8], [0.0, 1.0, 0.0]] {
            let ray = Ray::new(origin, Point(direction), 4.0).expect("a direction");
            let [field, exact] = [own.along(&ray, ray.span()), built_in.along(&ray, ray.span())];
            let [depth, expected] = [&field, &exact].map(|field| field.optical_depth(part));
            let off = (depth.value - expected.value).abs();
            assert!(off <= depth.error + expected.error && depth.error < 1e-13, "{direction:?}");
            assert!((field.at(1.5) - exact.at(1.5)).abs() < 1e-14);
            let [flight, expected] =
                [field, exact].map(|field| field.free_flight(part, 0.4 * expected.value));
            let off = flight.zip(expected).map(|(flight, expected)| (flight - expected).abs());
            assert!(off.is_some_and(|off| off < 1e-12), "{direction:?}");
        }
        let down = Ray::new(Point([0.0, 0.0, 2.5]), Point([0.0, 0.0, -1.0]), 3.0).expect("a ray");
        let breaks = own.along(&down, down.span()).breaks(down.span());
        assert!(matches!(breaks[..], [t] if (t - 1.25).abs() < 1e-15), "{breaks:?}");
    }
}

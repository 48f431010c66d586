//! A homogeneous field.
//!
//! ```text
//! σ_t = extinction
//! ```
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `extinction` | σ_t ≥ 0 | 1/length | required |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Optical depth and free flight are closed forms.

use super::{Extinction, Field, FreeFlight, OpticalDepth, body};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Aabb, Bounds, Ray};
use numeric::{Known, Lane, Span};

/// A homogeneous volume.
pub struct Constant {
    extinction: f64,
    bounds: Bounds,
}

impl Constant {
    /// A field with `σ_t ≥ 0`, 1/length, within bounds.
    pub fn new(extinction: f64, bounds: Bounds) -> Self {
        Self { extinction, bounds }
    }
}

/// A homogeneous interval of a ray.
pub struct Homogeneous {
    /// `σ_t ≥ 0`, 1/length.
    pub extinction: f64,
}

impl Extinction for Homogeneous {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        t.each(self.extinction)
    }

    fn single_value(&self) -> Option<f64> {
        Some(self.extinction)
    }
}

impl OpticalDepth for Homogeneous {
    fn optical_depth(&self, span: Span) -> Known {
        Known::exact(self.extinction * span.length())
    }
}

impl FreeFlight for Homogeneous {
    fn is_direct(&self) -> bool {
        true
    }

    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        let s = span.from + depth / self.extinction;
        (s < span.to).then_some(s)
    }
}

impl Field for Constant {
    type Profile = Homogeneous;

    const EXTINCTIONS: &'static [&'static str] = &["extinction"];

    fn line(settings: &Settings) -> Option<Homogeneous> {
        let extinction = settings.number("extinction", Domain::NonNegative)?;
        Some(Homogeneous { extinction })
    }

    fn volume(settings: &Settings) -> Option<Self> {
        let extinction = settings.number("extinction", Domain::NonNegative);
        let bounds = body::read_bounds(settings);
        Some(Self { extinction: extinction?, bounds: bounds? })
    }

    fn bounds(&self) -> Bounds {
        self.bounds
    }

    #[inline(always)]
    fn extinction_at<L: Lane>(&self, [x, ..]: [L; 3]) -> L {
        x.each(self.extinction)
    }

    fn majorant(&self, _: &Aabb) -> f64 {
        self.extinction
    }

    fn single_value(&self) -> Option<f64> {
        Some(self.extinction)
    }

    fn along(&self, _: &Ray, _: Span) -> Homogeneous {
        Homogeneous { extinction: self.extinction }
    }

    fn is_radial(&self) -> bool {
        matches!(self.bounds, Bounds::Sphere { .. })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flight_inverts_depth() {
        let field = Homogeneous { extinction: 0.5 };
        assert_eq!(field.optical_depth(Span::new(1.0, 5.0)).value, 2.0);
        assert_eq!(field.free_flight(Span::new(1.0, 5.0), 1.0), Some(3.0));
        assert_eq!(field.free_flight(Span::new(1.0, 5.0), 2.5), None);
    }

    #[test]
    fn vacuum_is_never_hit() {
        let field = Homogeneous { extinction: 0.0 };
        assert_eq!(field.free_flight(Span::new(0.0, 1.0), 1e-9), None);
    }
}

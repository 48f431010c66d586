//! A Gaussian blob.
//!
//! ```text
//! σ_t(p) = peak · exp(−|p − centre|² / (2 width²))
//! ```
//!
//! In 1-D `p` is the distance `t` and `centre` a number; in 3-D both are points.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `peak` | σ_t at the centre, ≥ 0 | 1/length | required |
//! | `centre` | a number, in 3-D `[x, y, z]` | length | required |
//! | `width` | standard deviation, > 0 | length | required |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Along a ray that passes the centre at the distance D, with its foot at `s_c`, the blob is a 1-D
//! Gaussian of peak A = peak·exp(−D²/(2 width²)):
//!
//! ```text
//! τ(a, b) = A width √(π/2) [erf z(b) − erf z(a)],   z(s) = (s − s_c)/(√2 width)
//! ```
//!
//! Where both z have one sign, erfc is subtracted instead of erf, so that tails keep their digits.
//! D comes from the residual vector, never from a difference of squares. The error bound counts one
//! rounding of each erf and the rounding of its argument; the free flight is a bracketed root.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use std::sync::Arc;

use super::{Extinction, Facts, Field, OpticalDepth, Profile, Reader, body};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span};

/// A Gaussian blob as a volume.
pub struct Gaussian {
    peak: f64,
    centre: Point,
    width: f64,
    bounds: Bounds,
}

/// Reads the page.
pub fn reader() -> Reader {
    Reader::new(&["peak"]).line(read_line).volume(read_volume)
}

fn read_line(settings: &Settings) -> Option<Bump> {
    let peak = settings.number("peak", Domain::NonNegative);
    let foot = settings.number("centre", Domain::Finite);
    let width = settings.number("width", Domain::Positive);
    Some(Bump { peak: peak?, foot: foot?, width: width? })
}

fn read_volume(settings: &Settings) -> Option<Gaussian> {
    let peak = settings.number("peak", Domain::NonNegative);
    let centre = settings.triple("centre").map(Point);
    let width = settings.number("width", Domain::Positive);
    let bounds = body::read_bounds(settings);
    Some(Gaussian { peak: peak?, centre: centre?, width: width?, bounds: bounds? })
}

impl Gaussian {
    /// Peak of at least 0, 1/length, and standard deviation above 0.
    pub fn new(peak: f64, centre: Point, width: f64, bounds: Bounds) -> Self {
        Self { peak, centre, width, bounds }
    }
}

/// A Gaussian along a ray.
pub struct Bump {
    peak: f64,
    foot: f64,
    width: f64,
}

impl Bump {
    /// Peak of at least 0, 1/length, its distance, and standard deviation above 0.
    pub fn new(peak: f64, centre: f64, width: f64) -> Self {
        Self { peak, foot: centre, width }
    }
}

impl Extinction for Bump {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        let u = (t - self.foot) * (1.0 / self.width);
        (u * u * -0.5).exp() * self.peak
    }
}

impl OpticalDepth for Bump {
    fn optical_depth(&self, span: Span) -> Known {
        let z = |s: f64| (s - self.foot) / self.width * FRAC_1_SQRT_2;
        let (a, b) = (z(span.from), z(span.to));
        let (low, high) = if a >= 0.0 {
            (-libm::erfc(a), -libm::erfc(b))
        } else if b <= 0.0 {
            (libm::erfc(-a), libm::erfc(-b))
        } else {
            (libm::erf(a), libm::erf(b))
        };
        let scale = self.peak * self.width * FRAC_PI_2.sqrt();
        let value = scale * (high - low);
        // A rounded end adds or removes an interval of the length of its rounding.
        let ends = [(span.from, a), (span.to, b)].map(|(s, z)| {
            let moved = 2.0 * (s.abs() + self.foot.abs()) + 4.0 * (s - self.foot).abs();
            self.peak * (-z * z).exp() * moved
        });
        let rounded = 4.0 * value + 2.0 * scale * (low.abs() + high.abs());
        Known::new(value, f64::EPSILON * (rounded + ends[0] + ends[1]))
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        // Frames of the blob's own width: equal panels would step over a narrow one.
        let widths = [-24.0, -12.0, -6.0, -3.0, -1.0, 0.0, 1.0, 3.0, 6.0, 12.0, 24.0];
        let at = widths.map(|n| self.foot + n * self.width);
        at.into_iter().filter(|&t| span.contains_inside(t)).collect()
    }
}

impl Field for Gaussian {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        (self.centre.square_to(p, 1.0 / self.width) * -0.5).exp() * self.peak
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        // The exponent of a lookup is rounded, too.
        self.value(within.nearest(self.centre).0) * (1.0 + 1e-12)
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        let (foot, offset) = ray.nearest_to(self.centre);
        let offset = offset * (1.0 / self.width);
        let peak = self.peak * (-0.5 * offset.dot(offset)).exp();
        Arc::new(Bump { peak, foot, width: self.width })
    }

    fn facts(&self) -> Facts<'_> {
        let is_radial = matches!(self.bounds, Bounds::Sphere { centre, radius }
            if centre == self.centre && self.width >= MIN_WIDTH * radius);
        Facts { is_radial, ..Facts::default() }
    }
}

/// Minimum width of a blob relative to its ball that the solver of light in balls resolves.
const MIN_WIDTH: f64 = 0.15;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_far_tail_keeps_its_digits() {
        // ∫₁₀^∞ e^{−x²/2} dx = √(2π) Q(10), Q(10) = 7.619853024160526e-24.
        let field = Bump { peak: 1.0, foot: 0.0, width: 1.0 };
        let exact = (2.0 * std::f64::consts::PI).sqrt() * 7.619_853_024_160_526e-24;
        for span in [Span::new(10.0, 60.0), Span::new(-60.0, -10.0)] {
            let depth = field.optical_depth(span);
            assert!((depth.value - exact).abs() < 1e-13 * exact);
            assert!(depth.error < 1e-12 * exact);
        }
    }
}

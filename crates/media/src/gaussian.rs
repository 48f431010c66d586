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

/// A Gaussian about a distance along a line, or about a point.
pub struct Gaussian<P = f64> {
    /// σ_t at the centre, at least 0, 1/length.
    pub peak: f64,
    /// Centre.
    pub centre: P,
    /// Standard deviation, above 0.
    pub width: f64,
}

impl<P> Gaussian<P> {
    fn read(settings: &Settings, centre: Option<P>) -> Option<Self> {
        let peak = settings.number("peak", Domain::NonNegative);
        let width = settings.number("width", Domain::Positive);
        Some(Self { peak: peak?, centre: centre?, width: width? })
    }
}

/// Reads the page.
pub fn reader() -> Reader {
    let line =
        |settings: &Settings| Gaussian::read(settings, settings.number("centre", Domain::Finite));
    let volume = |settings: &Settings| {
        let gaussian = Gaussian::read(settings, settings.triple("centre").map(Point));
        let bounds = body::read_bounds(settings);
        Some(Blob { gaussian: gaussian?, bounds: bounds? })
    };
    Reader::new(&["peak"]).line(line).volume(volume)
}

impl Extinction for Gaussian {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        let u = (t - self.centre) * (1.0 / self.width);
        (u * u * -0.5).exp() * self.peak
    }
}

impl OpticalDepth for Gaussian {
    fn optical_depth(&self, span: Span) -> Known {
        let z = |s: f64| (s - self.centre) / self.width * FRAC_1_SQRT_2;
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
            let moved = 2.0 * (s.abs() + self.centre.abs()) + 4.0 * (s - self.centre).abs();
            self.peak * (-z * z).exp() * moved
        });
        let rounded = 4.0 * value + 2.0 * scale * (low.abs() + high.abs());
        Known::new(value, f64::EPSILON * (rounded + ends[0] + ends[1]))
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        // Frames of the blob's own width: equal panels would step over a narrow one.
        let widths = [-24.0, -12.0, -6.0, -3.0, -1.0, 0.0, 1.0, 3.0, 6.0, 12.0, 24.0];
        let at = widths.map(|n| self.centre + n * self.width);
        at.into_iter().filter(|&t| span.contains_inside(t)).collect()
    }
}

/// A Gaussian blob as a volume.
pub struct Blob {
    /// The Gaussian.
    pub gaussian: Gaussian<Point>,
    /// Bounds.
    pub bounds: Bounds,
}

/// Minimum width of a blob relative to its ball that the solver of light in balls resolves.
const MIN_WIDTH: f64 = 0.15;

impl Field for Blob {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        let Gaussian { peak, centre, width } = self.gaussian;
        (centre.square_to(p, 1.0 / width) * -0.5).exp() * peak
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        // The exponent of a lookup is rounded, too.
        self.value(within.nearest(self.gaussian.centre).0) * (1.0 + 1e-12)
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        let Gaussian { peak, centre, width } = self.gaussian;
        let (foot, offset) = ray.nearest_to(centre);
        let offset = offset * (1.0 / width);
        let peak = peak * (-0.5 * offset.dot(offset)).exp();
        Arc::new(Gaussian { peak, centre: foot, width })
    }

    fn facts(&self) -> Facts<'_> {
        let is_radial = matches!(self.bounds, Bounds::Sphere { centre, radius }
            if centre == self.gaussian.centre && self.gaussian.width >= MIN_WIDTH * radius);
        Facts { is_radial, ..Facts::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_far_tail_keeps_its_digits() {
        // ∫₁₀^∞ e^{−x²/2} dx = √(2π) Q(10), Q(10) = 7.619853024160526e-24.
        let field = Gaussian { peak: 1.0, centre: 0.0, width: 1.0 };
        let exact = (2.0 * std::f64::consts::PI).sqrt() * 7.619_853_024_160_526e-24;
        for span in [Span::new(10.0, 60.0), Span::new(-60.0, -10.0)] {
            let depth = field.optical_depth(span);
            assert!((depth.value - exact).abs() < 1e-13 * exact);
            assert!(depth.error < 1e-12 * exact);
        }
    }
}

//! A Gaussian blob, or a Gaussian layer.
//!
//! ```text
//! σ_t(p) = peak · exp(−|p − centre|² / (2 width²))       about a point
//! σ_t(x) = peak · exp(−(x − centre)² / (2 width²))       about a distance or a height
//! ```
//!
//! In 1-D `x` is the distance `t`; in 3-D, with a number as `centre`, it is the height `p·axis`.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `peak` | σ_t at the centre, ≥ 0 | 1/length | required |
//! | `centre` | a number; in 3-D `[x, y, z]` of a blob, or a number for a layer | length | required |
//! | `width` | standard deviation, > 0 | length | required |
//! | `axis` | layers in 3-D only: the direction of `x`; it is normalised | | `[0, 0, 1]` |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Along a ray both are 1-D Gaussians. Past a blob at the distance D, with its foot at `s_c`, the peak is
//! A = peak·exp(−D²/(2 width²)). Across a layer at the cosine μ, the width is width/|μ|.
//!
//! ```text
//! τ(a, b) = A width √(π/2) [erf z(b) − erf z(a)],   z(s) = (s − s_c)/(√2 width)
//! ```
//!
//! Where both z have one sign, erfc is subtracted instead of erf, so that tails keep their digits. Across layers, where z
//! changes by less than 0.001 as along a ray that is almost level, a series about the middle takes the place of the difference.
//! D comes from the residual vector, never from a difference of squares. The error bound counts one
//! rounding of each erf and the rounding of its argument; the free flight is a bracketed root.
//!
//! ```toml
//! title = "An example of gaussian"
//!
//! [problem.transmittance]
//! medium.gaussian = { peak = 1.2, centre = 0.7, width = 1 }
//! span = [-2, 4]
//! sampling = 1.2
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use std::sync::Arc;

use super::layered::{Heights, Stratified};
use super::{Facts, Field, Profile, Reader, body};
use crate::catalogue::{Domain, Settings, Value};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span};

/// A Gaussian about a distance or a height, or about a point.
#[derive(Clone)]
pub struct Gaussian<P = f64> {
    peak: f64,
    centre: P,
    width: f64,
    /// Across layers: size of the terms that the centre is a difference of; ε times this bounds their rounding. 0 along a line.
    terms: f64,
}

impl<P> Gaussian<P> {
    /// A Gaussian with σ_t ≥ 0 at its centre, 1/length, and a standard deviation above 0.
    pub fn new(peak: f64, centre: P, width: f64) -> Self {
        Self { peak, centre, width, terms: 0.0 }
    }

    fn read_about(settings: &Settings, centre: Option<P>) -> Option<Self> {
        let peak = settings.number("peak", Domain::NonNegative);
        let width = settings.number("width", Domain::Positive);
        Some(Self::new(peak?, centre?, width?))
    }
}

/// Half the change of z below which the error functions of its ends are not subtracted.
const SHORT: f64 = 5e-4;

impl Gaussian {
    /// `∫ σ_t` about the middle of a short interval, where z is m ∓ h.
    ///
    /// ```text
    /// L A e^{−m²} [1 + h²(4m² − 2)/6 + h⁴(16m⁴ − 48m² + 12)/120 + …]
    /// ```
    fn about_middle(&self, x: Span, half: f64) -> Known {
        let u = (x.middle() - self.centre) / self.width;
        // e^{−1000} is 0.
        let (m2, h2) = ((0.5 * u * u).min(1000.0), half * half);
        let fourth = (16.0 * m2 - 48.0) * m2 + 12.0;
        let mean = 1.0 + h2 * ((4.0 * m2 - 2.0) / 6.0 + h2 * fourth / 120.0);
        let value = x.length() * self.peak * (-m2).exp() * mean;
        let moved = 2.0 * (x.middle().abs() + self.centre.abs() + self.terms) / self.width;
        let rounding = 8.0 + (1.0 + u.abs()) * (moved + 4.0 * u.abs());
        Known::new(value, value * f64::EPSILON * rounding)
    }
}

impl Stratified for Gaussian {
    const EXTINCTIONS: &'static [&'static str] = &["peak"];

    fn read(settings: &Settings) -> Option<Self> {
        Self::read_about(settings, settings.number("centre", Domain::Finite))
    }

    #[inline(always)]
    fn value<L: Lane>(&self, x: L) -> L {
        let u = (x - self.centre) * (1.0 / self.width);
        (u * u * -0.5).exp() * self.peak
    }

    fn integral(&self, x: Span) -> Known {
        let half = 0.5 * FRAC_1_SQRT_2 * x.length() / self.width;
        // Along a line the ends are exact, and a rounded middle would lose digits of a far tail.
        if half < SHORT && self.terms > 0.0 {
            return self.about_middle(x, half);
        }
        let z = |s: f64| (s - self.centre) / self.width * FRAC_1_SQRT_2;
        let (a, b) = (z(x.from), z(x.to));
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
        let ends = [(x.from, a), (x.to, b)].map(|(s, z)| {
            let sizes = s.abs() + self.centre.abs() + self.terms;
            self.peak * (-z * z).exp() * (2.0 * sizes + 4.0 * (s - self.centre).abs())
        });
        let rounded = 4.0 * value + 2.0 * scale * (low.abs() + high.abs());
        Known::new(value, f64::EPSILON * (rounded + ends[0] + ends[1]))
    }

    fn highest(&self, x: Span) -> f64 {
        // The exponent of a lookup is rounded, too.
        self.value(self.centre.max(x.from).min(x.to)) * (1.0 + 1e-12)
    }

    /// Frames of the Gaussian's own width: equal panels would step over a narrow one.
    fn features(&self, _: Span) -> Vec<f64> {
        let widths = [-24.0, -12.0, -6.0, -3.0, -1.0, 0.0, 1.0, 3.0, 6.0, 12.0, 24.0];
        widths.map(|n| self.centre + n * self.width).into()
    }

    /// Heights become distances, but not along a level ray.
    fn along(&self, &Heights { start, slope, .. }: &Heights, _: Span) -> Option<Self> {
        let per_height = 1.0 / slope.abs();
        let terms = ((start.abs() + self.centre.abs()) * per_height).max(f64::MIN_POSITIVE);
        let (centre, width) = ((self.centre - start) / slope, self.width * per_height);
        let is_kept = width.is_finite() && terms.is_finite();
        is_kept.then_some(Self { peak: self.peak, centre, width, terms })
    }
}

/// A Gaussian blob as a volume.
pub struct Blob {
    /// The Gaussian.
    pub gaussian: Gaussian<Point>,
    /// Bounds.
    pub bounds: Bounds,
}

/// Reads the page.
pub fn reader() -> Reader {
    let help = "it is for layers: give `centre` as one number, or leave `axis` out";
    Reader::layered::<Gaussian>().or_volume(is_blob, Blob::read, help)
}

fn is_blob(settings: &Settings) -> bool {
    match settings.entry("centre").map(|entry| &entry.node.value) {
        Some(Value::Number(_)) => false,
        Some(_) => true,
        None => !settings.has("axis"),
    }
}

/// Minimum width of a blob relative to its ball that the solver of light in balls resolves.
const MIN_WIDTH: f64 = 0.15;

impl Blob {
    fn read(settings: &Settings) -> Option<Self> {
        let gaussian = Gaussian::read_about(settings, settings.triple("centre").map(Point));
        let bounds = body::read_bounds(settings);
        Some(Self { gaussian: gaussian?, bounds: bounds? })
    }
}

impl Field for Blob {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        let Gaussian { peak, centre, width, .. } = self.gaussian;
        (centre.square_to(p, 1.0 / width) * -0.5).exp() * peak
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        // The exponent of a lookup is rounded, too.
        self.value(within.nearest(self.gaussian.centre).0) * (1.0 + 1e-12)
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        let Gaussian { peak, centre, width, .. } = self.gaussian;
        let (foot, offset) = ray.nearest_to(centre);
        let offset = offset * (1.0 / width);
        let peak = peak * (-0.5 * offset.dot(offset)).exp();
        Arc::new(Gaussian::new(peak, foot, width))
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
        let field = Gaussian::new(1.0, 0.0, 1.0);
        let exact = (2.0 * std::f64::consts::PI).sqrt() * 7.619_853_024_160_526e-24;
        for span in [Span::new(10.0, 60.0), Span::new(-60.0, -10.0)] {
            let depth = field.integral(span);
            assert!((depth.value - exact).abs() < 1e-13 * exact);
            assert!(depth.error < 1e-12 * exact);
        }
    }
}

//! An exponential atmosphere, in a haze if one is given.
//!
//! ```text
//! σ_t(x) = base + extinction · exp(−rate · x)
//! ```
//!
//! In 1-D `x` is the distance `t`; in 3-D it is the height `p·axis`. `rate = 1/H` for an
//! atmosphere of scale height H; a negative rate grows along `x`, rate 0 is homogeneous.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `extinction` | σ_t at x = 0, ≥ 0 | 1/length | required |
//! | `rate` | decay of ln σ_t | 1/length | required |
//! | `base` | what is left far up, ≥ 0 | 1/length | 0 |
//! | `axis` | 3-D only: the direction of `x`; it is normalised | | `[0, 0, 1]` |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Optical depth and, without a base, free flight are closed forms, with q the extinction at the denser end and
//! y = |rate·L| over a stretch of length L:
//!
//! ```text
//! τ = base L + q L (1 − e^{−y})/y,   s = −ln(1 − u·rate/σ_t(from))/rate
//! ```
//!
//! Relative error of τ: 1e-15 and the rounding of the exponent, |rate·x|·2.2e-16. Exponents
//! above 709 are infinite in double precision: bound a medium that grows.

use super::layered::{Heights, Stratified};
use super::profile::free_flight_by_root;
use super::{Facts, Reader};
use crate::catalogue::{Domain, Settings};
use numeric::{Known, Lane, Span};

/// Exponent below which `e^x` loses digits.
const MIN_EXPONENT: f64 = -700.0;

/// An exponential atmosphere.
///
/// ```text
/// σ_t(x) = base + scale · exp(offset + slope · x)
/// ```
///
/// Scale and offset are kept apart, so that a far origin of a ray cannot overflow.
#[derive(Clone)]
pub struct Exponential {
    base: f64,
    scale: f64,
    offset: f64,
    slope: f64,
}

/// Reads the page.
pub fn reader() -> Reader {
    Reader::layered::<Exponential>()
}

impl Exponential {
    /// The field `extinction · exp(−rate · x)`, with an extinction of at least 0, 1/length, and a rate, 1/length.
    pub fn new(extinction: f64, rate: f64) -> Self {
        Self { base: 0.0, scale: extinction, offset: 0.0, slope: -rate }
    }

    fn exponent(&self, x: f64) -> f64 {
        self.offset + self.slope * x
    }

    /// The field without the base.
    fn decay(&self, x: f64) -> f64 {
        let exponent = self.exponent(x);
        if exponent >= MIN_EXPONENT {
            return self.scale * exponent.exp();
        }
        // Next to underflow e^x has few digits, which a large scale would expose.
        let half = (0.5 * exponent).exp();
        self.scale * half * half
    }
}

impl Stratified for Exponential {
    const EXTINCTIONS: &'static [&'static str] = &["extinction", "base"];

    fn read(settings: &Settings) -> Option<Self> {
        let extinction = settings.number("extinction", Domain::NonNegative);
        let rate = settings.number("rate", Domain::Finite);
        let base = settings.number_or("base", Domain::NonNegative, 0.0);
        Some(Self { base: base?, ..Self::new(extinction?, rate?) })
    }

    #[inline(always)]
    fn value<L: Lane>(&self, x: L) -> L {
        (x * self.slope + self.offset).exp() * self.scale + self.base
    }

    fn integral(&self, x: Span) -> Known {
        let length = x.length();
        let dense = if self.slope > 0.0 { x.to } else { x.from };
        let y = self.slope.abs() * length;
        let mean = if y == 0.0 { 1.0 } else { -(-y).exp_m1() / y };
        let value = self.decay(dense) * length * mean + self.base * length;
        let rounding = 4.0 + self.offset.abs() + 2.0 * (self.slope * dense).abs();
        Known::new(value, value * f64::EPSILON * rounding)
    }

    fn highest(&self, x: Span) -> f64 {
        let exponent = self.exponent(x.from).max(self.exponent(x.to));
        // The exponents of the lookups are rounded, too.
        (self.base + self.scale * exponent.exp()) * (1.0 + 1e-12)
    }

    fn inverse(&self, x: Span, depth: f64) -> Option<f64> {
        if self.base > 0.0 {
            return free_flight_by_root(self, x, depth);
        }
        let first = self.decay(x.from);
        let growth = depth * self.slope / first;
        let flight = if self.slope == 0.0 {
            depth / first
        } else if growth == f64::INFINITY {
            // The density at the beginning underflows or is lost beside the growth: ln(1 + x) ≈ ln x.
            ((depth * self.slope / self.scale).ln() - self.exponent(x.from)) / self.slope
        } else if growth > -1.0 {
            growth.ln_1p() / self.slope
        } else {
            return None;
        };
        let s = x.from + flight;
        (s < x.to).then_some(s)
    }

    /// Places at the decay's own scale: equal panels would miss a steep one.
    fn features(&self, x: Span) -> Vec<f64> {
        let frames = [1.0, 4.0, 16.0, 40.0].map(|lengths| lengths / self.slope.abs());
        let at = frames.map(|s| if self.slope > 0.0 { x.to - s } else { x.from + s });
        at.into_iter().filter(|&t| x.contains_inside(t)).collect()
    }

    fn facts(&self) -> Facts<'_> {
        Facts { has_inverse: self.base == 0.0, ..Facts::default() }
    }

    fn along(&self, &Heights { start, slope, .. }: &Heights, _: Span) -> Option<Self> {
        Some(Self { offset: self.exponent(start), slope: self.slope * slope, ..*self })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Field, Layered};
    use super::*;
    use numeric::geometry::{Bounds, Point, Ray};

    #[test]
    fn depth_of_an_oblique_ray() {
        let axis = Point([0.0, 0.0, 1.0]);
        let field = Layered::new(Exponential::new(2.0, 0.35), axis, Bounds::Everywhere);
        let ray = Ray::new(Point([1.0, -2.0, 0.5]), Point([1.0, 2.0, 2.0]), 7.0).expect("a ray");
        let depth = field.along(&ray, ray.span()).optical_depth(ray.span());
        // 30-digit arithmetic.
        assert!((depth.value - 5.790_256_282_697_923).abs() <= depth.error);
        assert!(depth.error < 2e-14);
    }

    #[test]
    fn a_vanishing_rate_is_homogeneous() {
        for slope in [0.0, 1e-300, -1e-300, 1e-18] {
            let field = Exponential { base: 0.0, scale: 0.5, offset: 0.0, slope };
            assert_eq!(field.integral(Span::new(1.0, 5.0)).value, 2.0);
            assert_eq!(field.inverse(Span::new(1.0, 5.0), 1.0), Some(3.0));
        }
    }

    #[test]
    fn a_thin_atmosphere_is_left() {
        // The whole half-line beyond 0 has the optical depth 1/1.
        let field = Exponential { base: 0.0, scale: 1.0, offset: 0.0, slope: -1.0 };
        assert_eq!(field.inverse(Span::new(0.0, 1e9), 1.0), None);
        let s = field.inverse(Span::new(0.0, 1e9), 0.5).expect("inside");
        assert!((s - std::f64::consts::LN_2).abs() < 1e-15);
    }

    /// e^{−727} has nine digits.
    #[test]
    fn a_large_scale_shows_no_underflow() {
        let (slope, scale) = (956.324_469_521_829_3, 6.397_761_024_764_652e196);
        let field = Exponential { base: 0.0, scale, offset: 0.0, slope };
        let span = Span::new(-0.759_942_721_560_702_7, -0.371_056_459_061_988_2);
        let depth = 3.315_785_944_374_523_7e37;
        let s = field.inverse(span, depth).expect("inside");
        let back = field.integral(Span::new(span.from, s)).value;
        assert!((back / depth - 1.0).abs() < 1e-11, "{back:e}");
    }

    #[test]
    fn a_haze_adds_to_depth_and_flight() {
        let field = Exponential { base: 0.2, scale: 1.2, offset: 0.0, slope: -0.5 };
        let span = Span::new(0.0, 3.0);
        // 0.6 + 2.4(1 − e^{−1.5})
        assert!((field.integral(span).value - 2.464_487_615_643_768_5).abs() < 1e-14);
        let s = field.inverse(span, 1.7).expect("inside");
        assert!((field.integral(Span::new(0.0, s)).value - 1.7).abs() < 1e-13);
        assert_eq!(field.inverse(span, 2.5), None);
        assert!((field.value(2.0) - (0.2 + 1.2 * (-1.0f64).exp())).abs() < 1e-15);
    }

    #[test]
    fn growth_out_of_nothing_is_inverted() {
        let field = Exponential { base: 0.0, scale: 1.0, offset: -1000.0, slope: 10.0 };
        let span = Span::new(0.0, 100.5);
        let s = field.inverse(span, 2.0).expect("inside");
        let back = field.integral(Span::new(0.0, s));
        assert!((back.value - 2.0).abs() <= 1e-12);
    }
}

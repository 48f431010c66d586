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
//!
//! ```toml
//! title = "An example of exponential"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use super::Facts;
use super::layered::{Heights, Stratified};
use super::profile::free_flight_by_root;
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
        frames.map(|s| if self.slope > 0.0 { x.to - s } else { x.from + s }).into()
    }

    fn facts(&self) -> Facts<'_> {
        Facts { has_inverse: self.base == 0.0, ..Facts::default() }
    }

    fn along(&self, &Heights { start, slope, .. }: &Heights, _: Span) -> Option<Self> {
        Some(Self { offset: self.exponent(start), slope: self.slope * slope, ..*self })
    }
}

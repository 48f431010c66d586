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
//!
//! ```toml
//! title = "An example of constant"
//!
//! [problem.transmittance]
//! medium.constant.extinction = 0.8
//! span = [0, 2]
//! sampling = 1
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use super::Facts;
use super::layered::{Heights, Layered, Stratified};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Bounds, Point};
use numeric::{Known, Lane, Span};

/// A homogeneous field.
#[derive(Clone)]
pub struct Constant {
    /// `σ_t ≥ 0`, 1/length.
    pub extinction: f64,
}

impl Constant {
    /// A homogeneous volume with `σ_t ≥ 0`, 1/length.
    pub fn within(extinction: f64, bounds: Bounds) -> Layered<Self> {
        Layered::new(Self { extinction }, Point([0.0, 0.0, 1.0]), bounds)
    }
}

impl Stratified for Constant {
    const EXTINCTIONS: &'static [&'static str] = &["extinction"];

    const HAS_AXIS: bool = false;

    fn read(settings: &Settings) -> Option<Self> {
        settings.number("extinction", Domain::NonNegative).map(|extinction| Self { extinction })
    }

    #[inline(always)]
    fn value<L: Lane>(&self, x: L) -> L {
        x.each(self.extinction)
    }

    fn integral(&self, x: Span) -> Known {
        Known::exact(self.extinction * x.length())
    }

    fn highest(&self, _: Span) -> f64 {
        self.extinction
    }

    fn inverse(&self, x: Span, depth: f64) -> Option<f64> {
        let s = x.from + depth / self.extinction;
        (s < x.to).then_some(s)
    }

    fn facts(&self) -> Facts<'_> {
        Facts { single_value: Some(self.extinction), has_inverse: true, ..Facts::default() }
    }

    fn along(&self, _: &Heights, _: Span) -> Option<Self> {
        Some(self.clone())
    }
}

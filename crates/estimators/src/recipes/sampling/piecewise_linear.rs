//! A σ̂ made of straight lines.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `knots` | ascending distances along the ray, two or more | length |
//! | `values` | σ̂ ≥ 0 at each knot | 1/length |
//!
//! Outside the knots the first and the last value go on. Free flight inverts each quadratic exactly:
//! `s = 2u/(y₀ + √(y₀² + 2ku))`.
//!
//! ```toml
//! title = "An example of piecewise-linear"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling.piecewise-linear = { knots = [0, 1.5, 5], values = [1.7, 0.6, 0.1] }
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::Settings;
use media::piecewise_linear::read_pieces;
use media::{Body, Control, Piecewise};

/// A piecewise-linear σ̂.
pub type PiecewiseLinear = Given<false>;

/// A σ̂ of given pieces, which are steps or join.
#[derive(Debug, Clone)]
pub struct Given<const STEPS: bool>(Piecewise);

impl<const STEPS: bool> FromSettings for Given<STEPS> {
    const EXTINCTIONS: &'static [&'static str] = &["values"];

    fn read(settings: &Settings, _: Option<&Body>) -> Option<Self> {
        read_pieces(settings, STEPS).map(Self)
    }
}

impl<const STEPS: bool> Recipe for Given<STEPS> {
    fn label(&self) -> String {
        if STEPS { "piecewise-constant" } else { "piecewise-linear" }.into()
    }

    fn prepare(&self, site: &Site, _: &Control) -> Result<Piecewise, Refusal> {
        Ok(self.0.on(site.mesh.support()))
    }
}

//! A σ̂ made of straight lines.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `knots` | ascending distances along the ray, two or more | length |
//! | `values` | σ̂ ≥ 0 at each knot | 1/length |
//!
//! Outside the knots the first and the last value go on. Free flight inverts each quadratic exactly:
//! `s = 2u/(y₀ + √(y₀² + 2ku))`.

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

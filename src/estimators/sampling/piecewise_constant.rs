//! A σ̂ that is constant between breaks.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `breaks` | ascending distances along the ray, n + 1 of them | length |
//! | `values` | σ̂ ≥ 0 between them, n of them | 1/length |
//!
//! Outside the breaks the first and the last value go on. Free flight inverts the piecewise optical
//! depth exactly.

use super::Recipe;
use crate::catalogue::Settings;
use crate::estimators::{Refusal, Site};
use crate::media::piecewise_linear::read_pieces;
use crate::media::{Body, Control, Piecewise};

/// A piecewise-constant σ̂.
#[derive(Debug, Clone)]
pub struct PiecewiseConstant(Piecewise);

impl PiecewiseConstant {
    /// Reads `{ breaks, values }`.
    pub fn read(settings: &Settings, _: Option<&Body>) -> Option<Self> {
        read_pieces(settings, true).map(Self)
    }
}

impl Recipe for PiecewiseConstant {
    fn label(&self) -> String {
        "piecewise-constant".into()
    }

    fn prepare(&self, site: &Site, _: &Control) -> Result<Piecewise, Refusal> {
        Ok(self.0.on(site.mesh.support()))
    }
}

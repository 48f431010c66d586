//! One σ̂ for the whole ray.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `value` | σ̂ > 0 | 1/length |
//!
//! Free flight: `s = −ln(u)/σ̂`.

use super::Recipe;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::{Domain, Settings};
use media::{Body, Control, Majorants, Piecewise, Volume};

/// A constant σ̂.
#[derive(Debug, Clone, Copy)]
pub struct Constant {
    /// σ̂, 1/length.
    pub value: f64,
}

impl FromSettings for Constant {
    const EXTINCTIONS: &'static [&'static str] = &["value"];

    fn read(settings: &Settings, _: Option<&Body>) -> Option<Self> {
        settings.number("value", Domain::Positive).map(|value| Self { value })
    }
}

impl Recipe for Constant {
    fn label(&self) -> String {
        "constant".into()
    }

    fn constant(&self) -> Option<f64> {
        Some(self.value)
    }

    fn prepare(&self, site: &Site, _: &Control) -> Result<Piecewise, Refusal> {
        Ok(Piecewise::constant(self.value, site.mesh.support()))
    }

    fn in_space(&self, volume: &Volume) -> Result<Majorants, Refusal> {
        Ok(Majorants::constant(self.value, volume))
    }
}

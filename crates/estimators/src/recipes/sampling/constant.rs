//! One σ̂ for the whole ray.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `value` | σ̂ > 0 | 1/length |
//!
//! Free flight: `s = −ln(u)/σ̂`.
//!
//! ```toml
//! title = "An example of constant"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling.constant.value = 1.2
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

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

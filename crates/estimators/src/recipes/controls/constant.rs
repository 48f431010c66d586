//! One σ_c for the whole ray.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `value` | σ_c, any finite number | 1/length |
//!
//! Above σ_t the residual is negative: negative extinction, a first-class case.
//!
//! ```toml
//! title = "An example of constant"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! control.constant.value = 0.4
//! estimators = ["residual-ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::{Domain, Settings};
use media::{Body, Control, Piecewise};

/// A constant control.
#[derive(Debug, Clone, Copy)]
pub struct Constant {
    /// σ_c, 1/length.
    pub value: f64,
}

impl FromSettings for Constant {
    const EXTINCTIONS: &'static [&'static str] = &["value"];

    fn read(settings: &Settings, _: Option<&Body>) -> Option<Self> {
        settings.number("value", Domain::Finite).map(|value| Self { value })
    }
}

impl Recipe for Constant {
    fn label(&self) -> String {
        format!("constant {}", self.value)
    }

    fn prepare(&self, site: &Site) -> Result<Control, Refusal> {
        Ok(Control::Pieces(Piecewise::constant(self.value, site.mesh.support())))
    }
}

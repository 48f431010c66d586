//! No control: σ_c = 0.
//!
//! It takes no settings. Useful to switch off a control that the case gives to all estimators.
//!
//! ```toml
//! title = "An example of none"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! control.none = {}
//! estimators = ["residual-ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::Settings;
use media::{Body, Control};

/// No control.
#[derive(Debug, Clone, Copy)]
pub struct None;

impl FromSettings for None {
    fn read(_: &Settings, _: Option<&Body>) -> Option<Self> {
        Some(Self)
    }
}

impl Recipe for None {
    fn label(&self) -> String {
        String::new()
    }

    fn prepare(&self, _: &Site) -> Result<Control, Refusal> {
        Ok(Control::None)
    }
}

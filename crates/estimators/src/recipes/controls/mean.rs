//! The mean of σ_t over the support: the best constant control of the double particle model.
//!
//! ```text
//! σ_c = τ/ℓ
//! ```
//!
//! It takes no settings. It needs τ: the exact answer is known where this control is.
//!
//! Source: Szirmay-Kalos et al. 2017, section 3.4, *Optimal control variate*.
//!
//! ```toml
//! title = "An example of mean"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! control.mean = {}
//! estimators = ["double"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::Knowledge;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::Settings;
use media::{Body, Control, Piecewise};

/// The mean of σ_t.
#[derive(Debug, Clone, Copy)]
pub struct Mean;

impl FromSettings for Mean {
    fn read(_: &Settings, _: Option<&Body>) -> Option<Self> {
        Some(Self)
    }
}

impl Recipe for Mean {
    fn label(&self) -> String {
        "mean".into()
    }

    fn needs(&self) -> Option<Knowledge> {
        Some(Knowledge::OpticalDepth)
    }

    fn prepare(&self, site: &Site) -> Result<Control, Refusal> {
        let support = site.mesh.support();
        if support.is_empty() {
            return Ok(Control::None);
        }
        let mean = site.mesh.optical_depth().value / support.length();
        Ok(Control::Pieces(Piecewise::constant(mean, support)))
    }
}

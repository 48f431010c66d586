//! The smallest σ_t on the ray: the largest constant control that leaves no negative extinction.
//!
//! ```text
//! σ_c = min σ_t
//! ```
//!
//! It takes no settings. The minimum is searched on the ray.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 4.
//!
//! ```toml
//! title = "An example of minimum"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! control.minimum = {}
//! estimators = ["decomposition"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::Knowledge;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::Settings;
use media::{Body, Control, Piecewise};

/// The minimum of σ_t.
#[derive(Debug, Clone, Copy)]
pub struct Minimum;

impl FromSettings for Minimum {
    fn read(_: &Settings, _: Option<&Body>) -> Option<Self> {
        Some(Self)
    }
}

impl Recipe for Minimum {
    fn label(&self) -> String {
        "minimum".into()
    }

    fn needs(&self) -> Option<Knowledge> {
        Some(Knowledge::Minimum)
    }

    fn prepare(&self, site: &Site) -> Result<Control, Refusal> {
        let smallest = site.mesh.largest(&|_, sigma| -sigma).map_or(0.0, |(_, value)| -value);
        Ok(Control::Pieces(Piecewise::constant(smallest.max(0.0), site.mesh.support())))
    }
}

//! Another field of the catalogue on the same line or ray.
//!
//! ```text
//! control.field.volume.gaussian = { … }    beside a `volume`
//! control.field.medium.exponential = { … } beside a `medium`
//! ```
//!
//! Its optical depth is as exact as when it is the medium. It may exceed σ_t anywhere.
//!
//! ```toml
//! title = "An example of field"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 0.5
//! control.field.medium.exponential = { extinction = 1.5, rate = 0.7 }
//! estimators = ["double"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::Settings;
use media::{Body, Control};

/// A catalogued field as a control.
pub struct CataloguedField(Body);

impl FromSettings for CataloguedField {
    fn read(settings: &Settings, body: Option<&Body>) -> Option<Self> {
        let Some(body) = body else {
            settings.has("medium");
            settings.has("volume");
            return None;
        };
        body.read_beside(settings).map(Self)
    }
}

impl Recipe for CataloguedField {
    fn label(&self) -> String {
        format!("field {}", self.0.name())
    }

    fn prepare(&self, site: &Site) -> Result<Control, Refusal> {
        Ok(Control::Field(self.0.seen_like(site.body).medium()))
    }
}

//! Another field of the catalogue on the same line or ray.
//!
//! ```text
//! control.field.volume.gaussian = { … }    beside a `volume`
//! control.field.medium.exponential = { … } beside a `medium`
//! ```
//!
//! Its optical depth is as exact as when it is the medium. It may exceed σ_t anywhere.

use super::Recipe;
use crate::catalogue::Settings;
use crate::estimators::{Refusal, Site};
use crate::media::{Body, Control, Medium};

/// A catalogued field as a control.
pub struct Field {
    name: String,
    field: Medium,
}

impl Field {
    /// Reads `{ medium.NAME = { … } }` or `{ volume.NAME = { … } }`, like the problem itself.
    pub fn read(settings: &Settings, body: Option<&Body>) -> Option<Self> {
        let Some(body) = body else {
            settings.has("medium");
            settings.has("volume");
            return None;
        };
        let beside = body.read_beside(settings)?;
        Some(Self { name: beside.name().to_owned(), field: beside.medium() })
    }
}

impl Recipe for Field {
    fn label(&self) -> String {
        format!("field {}", self.name)
    }

    fn prepare(&self, _: &Site) -> Result<Control, Refusal> {
        Ok(Control::Field(self.field.clone()))
    }
}

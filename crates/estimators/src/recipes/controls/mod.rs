//! Recipes for the control σ_c: what is integrated exactly. It may exceed σ_t.

pub mod constant;
pub mod explorers;
pub mod field;
pub mod mean;
pub mod minimum;
pub mod none;

use super::{Refusal, Site, recipes};
use crate::Knowledge;
use media::Control;

/// A recipe for a control: it makes σ_c for a medium.
pub trait Recipe: Send + Sync {
    /// Label in words, as in `constant 0.3`; empty for no control.
    fn label(&self) -> String;

    /// Makes σ_c on the support of the medium.
    ///
    /// # Errors
    ///
    /// A requirement of the recipe that the medium does not fulfil.
    fn prepare(&self, site: &Site) -> Result<Control, Refusal>;

    /// Returns the recipe with another number of points; `None` if it has no points.
    fn with_points(&self, points: usize) -> Option<Box<dyn Recipe>> {
        let _ = points;
        None
    }

    /// Number of lookups of σ_t that a renderer spends on the control for each ray.
    fn lookups(&self) -> usize {
        0
    }

    /// Knowledge of the medium that the control needs beside lookups, as in `τ`; `None` for none.
    fn needs(&self) -> Option<Knowledge> {
        None
    }

    /// Points to which the control was fitted: `(t, σ_c)`.
    fn points(&self, site: &Site) -> Vec<[f64; 2]> {
        let _ = site;
        Vec::new()
    }
}

recipes! {
    "controls", Recipe:
    none::None,
    constant::Constant,
    mean::Mean,
    minimum::Minimum,
    explorers::Explorers,
    field::Field,
}

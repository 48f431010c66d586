//! Recipes for the control σ_c: what is integrated exactly. It may exceed σ_t.

pub mod constant;
pub mod explorers;
pub mod field;
pub mod mean;
pub mod minimum;
pub mod none;

use super::{FromSettings, RecipeReader, Refusal, Site};
use crate::Knowledge;
use media::catalogue::{Registry, Settings};
use media::{Body, Control, registry};

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

type Reader = RecipeReader<dyn Recipe>;

impl Reader {
    const fn of<P: Recipe + FromSettings + 'static>() -> Self {
        let read = |settings: &Settings, body: Option<&Body>| {
            P::read(settings, body).map(|page| Box::new(page) as Box<dyn Recipe>)
        };
        Self { extinctions: P::EXTINCTIONS, read }
    }
}

/// Every recipe, in the order of registration.
pub static CATALOGUE: Registry<Reader> = registry![
    Reader of
    none::None,
    constant::Constant,
    mean::Mean,
    minimum::Minimum,
    explorers::Explorers,
    field::CataloguedField,
];

/// Reads `{ NAME = { … } }`. The body is `None` after a mistake in it: checks that depend on it are skipped.
pub fn read(settings: &Settings, body: Option<&Body>) -> Option<Box<dyn Recipe>> {
    CATALOGUE.read(settings, |reader, page| (reader.read)(page, body))
}

/// Settings of a named recipe that its field is proportional to; empty for an unknown recipe.
pub fn extinctions(name: &str) -> &'static [&'static str] {
    CATALOGUE.get(name).map_or(&[], |reader| reader.extinctions)
}

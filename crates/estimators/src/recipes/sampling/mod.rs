//! Recipes for the sampling extinction σ̂: any non-negative field that inverts exactly.

pub mod constant;
pub mod local_majorants;
pub mod piecewise_constant;
pub mod piecewise_linear;
pub mod pilot;
pub mod spectral;

use super::{FromSettings, RecipeReader, Refusal, Site};
use crate::Knowledge;
use media::catalogue::{Registry, Settings};
use media::{Body, Control, Majorants, Piecewise, Volume, registry};

/// A recipe for a sampling extinction: it makes σ̂ for a medium and a control.
pub trait Recipe: Send + Sync {
    /// Label in words, as in `constant 0.4`.
    fn label(&self) -> String;

    /// The value, if it is one constant for every medium.
    fn constant(&self) -> Option<f64> {
        None
    }

    /// Returns whether σ̂ depends on lookups of σ_t at random places.
    fn learns(&self) -> bool {
        false
    }

    /// True if σ̂ is a majorant of each part of the ray or the volume.
    fn is_local(&self) -> bool {
        false
    }

    /// The recipes of the channels of a spectral medium, where each has its own.
    fn channels(&self) -> &[Box<dyn Recipe>] {
        &[]
    }

    /// Makes σ̂ on the support of the medium.
    ///
    /// # Errors
    ///
    /// A requirement of the recipe that the medium does not fulfil.
    fn prepare(&self, site: &Site, control: &Control) -> Result<Piecewise, Refusal>;

    /// Makes σ̂, and counts the lookups of σ_t that it took.
    ///
    /// # Errors
    ///
    /// A requirement of the recipe that the medium does not fulfil.
    fn prepare_counted(&self, site: &Site, control: &Control) -> Result<(Piecewise, u64), Refusal> {
        self.prepare(site, control).map(|sampling| (sampling, 0))
    }

    /// Knowledge of the medium that σ̂ needs beside lookups, as in `max |σ_t − σ_c|`; `None` for none.
    fn needs(&self) -> Option<Knowledge> {
        None
    }

    /// Makes σ̂ in a volume, for particles that leave the ray.
    ///
    /// # Errors
    ///
    /// The recipe makes it along rays only.
    fn in_space(&self, volume: &Volume) -> Result<Majorants, Refusal> {
        let _ = volume;
        Err(along_ray_only(&self.label()))
    }
}

/// The recipe of a channel: its own, or that of all channels.
pub fn of_channel(recipe: &dyn Recipe, channel: usize) -> &dyn Recipe {
    recipe.channels().get(channel).map_or(recipe, |own| &**own)
}

/// Makes σ̂ in a volume by a recipe; zero for estimators that take none.
///
/// # Errors
///
/// The recipe makes it along rays only.
pub fn in_space(recipe: Option<&dyn Recipe>, volume: &Volume) -> Result<Majorants, Refusal> {
    recipe.map_or_else(|| Ok(Majorants::constant(0.0, volume)), |recipe| recipe.in_space(volume))
}

/// The refusal of a recipe that makes σ̂ along rays only.
fn along_ray_only(label: &str) -> Refusal {
    let needs = "σ̂ in space: `constant`, or `local-majorants` with a `grid`";
    Refusal::mismatch(needs, format!("σ̂ is given along the ray ({label})"))
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
    constant::Constant,
    piecewise_constant::PiecewiseConstant,
    piecewise_linear::PiecewiseLinear,
    local_majorants::LocalMajorants,
    pilot::Pilot,
];

/// Reads `{ NAME = { … } }`. The body is `None` after a mistake in it: checks that depend on it are skipped.
pub fn read(settings: &Settings, body: Option<&Body>) -> Option<Box<dyn Recipe>> {
    CATALOGUE.read(settings, |reader, page| (reader.read)(page, body))
}

/// Settings of a named recipe that its field is proportional to; empty for an unknown recipe.
pub fn extinctions(name: &str) -> &'static [&'static str] {
    CATALOGUE.get(name).map_or(&[], |reader| reader.extinctions)
}

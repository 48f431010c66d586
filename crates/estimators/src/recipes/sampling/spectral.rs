//! A σ̂ for each channel of a spectral medium: `sampling = [{ constant.value = 1.6 }, …]`.

use super::Recipe;
use crate::Knowledge;
use crate::recipes::{Refusal, Site};
use media::{Control, Piecewise};

/// One recipe for each channel.
pub struct Spectral {
    recipes: Vec<Box<dyn Recipe>>,
}

impl Spectral {
    /// Joins the recipes, of which there is at least one.
    pub fn new(recipes: Vec<Box<dyn Recipe>>) -> Self {
        Self { recipes }
    }
}

impl Recipe for Spectral {
    fn label(&self) -> String {
        let labels = self.recipes.iter().map(|recipe| match recipe.constant() {
            // To six digits: blended channels have sixteen.
            Some(value) => format!("{value:.5e}").parse().unwrap_or(value).to_string(),
            None => recipe.label(),
        });
        labels.collect::<Vec<_>>().join(", ")
    }

    fn channels(&self) -> &[Box<dyn Recipe>] {
        &self.recipes
    }

    fn learns(&self) -> bool {
        self.recipes.iter().any(|recipe| recipe.learns())
    }

    fn is_local(&self) -> bool {
        self.recipes.iter().any(|recipe| recipe.is_local())
    }

    fn needs(&self) -> Option<Knowledge> {
        self.recipes.iter().find_map(|recipe| recipe.needs())
    }

    fn prepare(&self, site: &Site, control: &Control) -> Result<Piecewise, Refusal> {
        self.recipes[0].prepare(site, control)
    }
}

//! Words about an experiment and its medium: names in tables, needs, contents of files, doubts.

use super::Scenario;
use crate::case::names::Names;
use crate::case::sweep::{Variation, What};
use estimators::recipes::sampling;
use media::misses;

impl Scenario {
    /// Contents of the files of the medium, a sentence each.
    pub fn facts(&self) -> Vec<String> {
        self.body.facts()
    }

    /// Doubts about the medium and its ray, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        misses::notes(&self.body, self.ray)
    }

    /// The field's name in the catalogue.
    pub fn medium(&self) -> &str {
        self.body.name()
    }

    /// Names of an experiment in tables.
    pub fn names(&self, estimator: usize, variation: Variation) -> Names {
        if let Some(Ok(names)) = self.varied(variation, |other| other.names(estimator, None)) {
            return names;
        }
        let parsed = &self.estimators.list[estimator];
        let swept_albedo = matches!(variation, Some((What::Albedo, _)));
        let control = self.with_control(estimator, variation, |recipe| recipe.label());
        let (sampling, sampling_kind) = match (variation, self.estimators.sampling_of(parsed)) {
            (Some((What::Sampling, value)), _) if self.depends_on(estimator, What::Sampling) => {
                (Some(value), "constant".into())
            }
            (Some((What::SamplingScale, factor)), Some(recipe)) => {
                let kind = format!("{factor} × {}", recipe.label());
                (recipe.constant().map(|value| value * factor), kind)
            }
            (_, Some(recipe)) => (recipe.constant(), recipe.label()),
            (_, None) => (None, String::new()),
        };
        let is_plain = control.is_empty() && sampling.is_some();
        let alias = if is_plain { parsed.alias() } else { None };
        let estimator = parsed.label(!swept_albedo);
        Names { estimator, sampling, sampling_kind, control, alias }
    }

    /// Knowledge of the medium that an experiment needs beside lookups, as in `τ, max |σ_t − σ_c|`.
    pub fn needs(&self, estimator: usize, variation: Variation) -> String {
        if let Some(Ok(needs)) = self.varied(variation, |other| other.needs(estimator, None)) {
            return needs;
        }
        let parsed = &self.estimators.list[estimator];
        let control = self.with_control(estimator, variation, |recipe| recipe.needs());
        // A swept σ̂ stands in the recipe's place.
        let is_swept = matches!(variation, Some((What::Sampling, _)));
        let recipe = self.estimators.sampling_of(parsed);
        let recipe = recipe.filter(|_| !(is_swept && self.depends_on(estimator, What::Sampling)));
        let own = parsed.features.needs.filter(|own| control != Some(own));
        let needs = [own, control, recipe.and_then(sampling::Recipe::needs)];
        needs.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

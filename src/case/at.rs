//! A case at one value of its sweep: names, predictions and preparation of its experiments.

use std::any::Any;

use crate::case::build::{Ready, refuse_what_cannot_be_computed};
use crate::case::names::Names;
use crate::case::scenario::Scenario;
use crate::case::sweep::{Variation, What};
use crate::record::plot_data::Course;
use estimators::recipes::sampling;
use estimators::{RayView, Refusal};
use media::{Control, Medium, Piecewise};
use numeric::rng::Address;
use theory::Prediction;

/// Address of pilot rays where only theory is asked: it needs no random numbers, but recipes that learn do.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// A case at one value of its sweep.
pub struct At<'a> {
    scenario: Held<'a>,
    /// Swept quantity other than the medium, with its value.
    variation: Variation,
}

/// A scenario of the case, or one that was read for a value beside its sweep.
enum Held<'a> {
    Listed(&'a Scenario),
    Beside(Box<Scenario>),
}

impl<'a> At<'a> {
    /// A scenario of the case where something beside the medium varies, or nothing.
    pub(super) fn listed(scenario: &'a Scenario, variation: Variation) -> Self {
        Self { scenario: Held::Listed(scenario), variation }
    }

    /// A scenario that was read for a value of a sweep of the medium.
    pub(super) fn beside(scenario: Scenario) -> Self {
        Self { scenario: Held::Beside(Box::new(scenario)), variation: None }
    }

    /// The medium and the estimators.
    pub fn scenario(&self) -> &Scenario {
        match &self.scenario {
            Held::Listed(scenario) => scenario,
            Held::Beside(scenario) => scenario,
        }
    }

    /// Names of an experiment in tables.
    pub fn names(&self, estimator: usize) -> Names {
        let (scenario, variation) = (self.scenario(), self.variation);
        let parsed = &scenario.estimators.list[estimator];
        let swept_albedo = matches!(variation, Some((What::Albedo, _)));
        let control = scenario.with_control(estimator, variation, |recipe| recipe.label());
        let (sampling, sampling_kind) = match (variation, scenario.estimators.sampling_of(parsed)) {
            (Some((What::Sampling, value)), _)
                if scenario.depends_on(estimator, What::Sampling) =>
            {
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
    pub fn needs(&self, estimator: usize) -> String {
        let (scenario, variation) = (self.scenario(), self.variation);
        let parsed = &scenario.estimators.list[estimator];
        let control = scenario.with_control(estimator, variation, |recipe| recipe.needs());
        // A swept σ̂ stands in the recipe's place.
        let is_swept = matches!(variation, Some((What::Sampling, _)));
        let recipe = scenario.estimators.sampling_of(parsed);
        let recipe =
            recipe.filter(|_| !(is_swept && scenario.depends_on(estimator, What::Sampling)));
        let own = parsed.features.needs.filter(|own| control != Some(own));
        let needs = [own, control, recipe.and_then(sampling::Recipe::needs)];
        needs.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    /// Prepares an experiment; pilot rays find their random numbers at `address`.
    ///
    /// # Errors
    ///
    /// Why it cannot be drawn.
    pub fn prepare(&self, estimator: usize, address: Address) -> Result<Ready, Refusal> {
        let (scenario, variation) = (self.scenario(), self.variation);
        let (parts, setup_lookups) = scenario.counted_parts(estimator, variation, None, address)?;
        let parsed = &scenario.estimators.list[estimator];
        let mut ready =
            scenario.problem.prepare(estimator, parts, parsed.order(), parsed.expect_biased)?;
        ready.prediction.setup_lookups = setup_lookups;
        refuse_what_cannot_be_computed(ready)
    }

    /// Prediction of an experiment, at a constant σ̂ of `what_if` if one is given; `None` if it is refused.
    pub fn predict(
        &self,
        estimator: usize,
        what_if: Option<f64>,
        pilots: Address,
    ) -> Option<Prediction> {
        let (scenario, variation) = (self.scenario(), self.variation);
        let (parts, setup_lookups) =
            scenario.counted_parts(estimator, variation, what_if, pilots).ok()?;
        let order = scenario.estimators.list[estimator].order();
        let prediction = scenario.problem.predict(estimator, parts, order)?;
        Some(Prediction { setup_lookups, ..prediction })
    }

    /// The ray seen from the side and the places where the control was fitted, for estimators of a
    /// curve.
    pub fn ray_view(&self, estimator: usize, address: Address) -> Option<(RayView, Vec<[f64; 2]>)> {
        let (scenario, variation) = (self.scenario(), self.variation);
        let parts = scenario.parts(estimator, variation, None, address).ok()?;
        let ray_view = scenario.problem.ray_view(estimator, parts, address)?;
        let site = scenario.site(address);
        let points = scenario.with_control(estimator, variation, |recipe| recipe.points(&site));
        Some((ray_view, points))
    }

    /// σ_t, control and σ̂ of each channel along the ray, and at the place of interest.
    pub fn courses(&self, estimator: usize, address: Address, at: Option<f64>) -> Vec<Course> {
        let scenario = self.scenario();
        let parts = scenario.parts(estimator, self.variation, None, address).ok();
        let sampling = parts.as_ref().map(|parts| {
            let further = parts.further.iter().map(|(_, sampling)| sampling.as_ref());
            std::iter::once(parts.sampling.as_ref()).chain(further).collect::<Vec<_>>()
        });
        let control = parts.as_ref().map(|parts| &parts.control);
        let media = scenario.media().iter().enumerate();
        let fields = media.map(|(channel, medium)| Fields {
            medium,
            control,
            sampling: sampling.as_ref().and_then(|all| *all.get(channel)?),
        });
        fields.filter_map(|fields| fields.course(at)).collect()
    }

    /// The largest `|σ_t − σ_c|` on the ray, 1/length: the natural scale of σ̂ for an estimator.
    pub fn natural_scale(&self, estimator: usize) -> f64 {
        let scenario = self.scenario();
        let parts = scenario.parts(estimator, self.variation, None, NOWHERE);
        let control = parts.and_then(|parts| scenario.problem.fitting_control(estimator, parts));
        let Ok(control) = control else { return 0.0 };
        let largest = scenario.mesh().largest(|t, sigma| (sigma - control.extinction(t)).abs());
        largest.map_or(0.0, |(_, size)| size)
    }

    /// Prepares the `Setup<P>` of an experiment, for draws that are made outside the catalogue.
    ///
    /// # Errors
    ///
    /// Why it cannot be drawn.
    pub fn setup(&self, estimator: usize, address: Address) -> Result<Box<dyn Any>, Refusal> {
        let scenario = self.scenario();
        scenario.problem.setup(estimator, scenario.parts(estimator, self.variation, None, address)?)
    }
}

/// Number of evenly spaced places on the ray; the place where an inequality fails is added.
const PLACES: usize = 99;

/// The fields of a channel, as far as they could be made.
struct Fields<'a> {
    /// σ_t.
    medium: &'a Medium,
    /// σ_c.
    control: Option<&'a Control>,
    /// σ̂.
    sampling: Option<&'a Piecewise>,
}

impl Fields<'_> {
    /// Values along the ray and at a place of interest; `None` on a ray of infinite length.
    fn course(&self, at: Option<f64>) -> Option<Course> {
        let (span, support) = (self.medium.span(), self.medium.support());
        let length = span.length();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        let place = |i: usize| span.from + length * (i as f64 / (PLACES - 1) as f64);
        let mut t: Vec<f64> = (0..PLACES).map(place).collect();
        t.extend(at.filter(|at| span.from <= *at && *at <= span.to));
        t.sort_by(f64::total_cmp);
        t.dedup();
        let inside = |t: f64| support.from <= t && t <= support.to;
        let along = |field: &dyn Fn(f64) -> f64| -> Vec<f64> {
            t.iter().map(|&t| if inside(t) { field(t) } else { 0.0 }).collect()
        };
        let control = self.control.filter(|control| !control.is_none());
        Some(Course {
            extinction: along(&|t| self.medium.extinction(t)),
            control: control.map_or_else(Vec::new, |control| along(&|t| control.extinction(t))),
            sampling: self.sampling.map_or_else(Vec::new, |field| along(&|t| field.value(t))),
            at,
            t,
        })
    }
}

//! A problem with its medium and the estimators of a case: from a sweep's value to an experiment.

mod labels;

use std::any::Any;
use std::sync::{Arc, OnceLock};

use crate::case::course::Fields;
use crate::case::estimator::{Defaults, Estimators};
use crate::case::problem::{AnyProblem, Parts, ProblemKind};
use crate::case::ready::{Ready, refuse_what_cannot_be_computed};
use crate::case::sweep::{Variation, What};
use crate::record::plot_data::Course;
use estimators::recipes::{controls, sampling};
use estimators::{Order, RayView, Refusal, Site};
use media::body::RayNeed;
use media::catalogue::{Fault, Settings};
use media::{Body, Medium, Piecewise};
use numeric::rng::Address;
use theory::{Mesh, Prediction};

/// Theory needs no random numbers, but recipes that learn from pilot rays do.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// A problem with its medium and estimators, which are numbered in the order of the case.
pub struct Scenario {
    body: Body,
    problem: Box<dyn AnyProblem>,
    /// That of each channel.
    meshes: OnceLock<Vec<Arc<Mesh>>>,
    estimators: Estimators,
    variants: Option<Variants>,
    /// Requirement of the problem on the ray.
    ray: RayNeed,
}

/// Reads the scenario at a value of the sweep; the error lists the mistakes.
pub type ReadVariant = Box<dyn Fn(f64) -> Result<Scenario, Vec<Fault>> + Send + Sync>;

/// What a scenario is along a sweep of the medium.
struct Variants {
    read: ReadVariant,
    /// At the values of the case.
    known: Vec<(f64, Scenario)>,
}

impl Scenario {
    /// Reads what follows the field: σ̂ and control for all, and the estimators.
    pub fn read(
        kind: &ProblemKind,
        settings: &Settings,
        body: Option<&Body>,
        defaults: Defaults,
        swept: Option<What>,
    ) -> Option<Self> {
        // A sweep that could not be read may have been one of σ̂.
        let unread = settings.has("sweep") && swept.is_none();
        let shared = settings.has("sampling") || swept == Some(What::Sampling) || unread;
        let defaults = (Defaults { sampling: shared, ..defaults }, swept);
        let mut estimators = None;
        let problem = (kind.read)(body, settings, &mut |reader| {
            let accept = |_: &Settings, _: Option<&dyn sampling::Recipe>| Some(());
            estimators = Estimators::read(settings, body, reader, defaults, &accept);
        });
        let (problem, estimators, body) = (problem?, estimators?, body?.clone());
        let (meshes, ray) = (OnceLock::new(), kind.ray);
        Some(Self { body, problem, meshes, estimators, variants: None, ray })
    }

    /// The same along a sweep of the medium, with what is known at the values of the case.
    #[must_use]
    pub fn with_variants(self, read: ReadVariant, known: Vec<(f64, Self)>) -> Self {
        Self { variants: Some(Variants { read, known }), ..self }
    }

    /// What `ask` says of the scenario at a value of a sweep of the medium; `None` where something else varies.
    fn varied<T>(
        &self,
        variation: Variation,
        ask: impl FnOnce(&Self) -> T,
    ) -> Option<Result<T, Refusal>> {
        let (_, value) = variation.filter(|(what, _)| what.rewrite().is_some())?;
        let variants = self.variants.as_ref()?;
        if let Some((_, known)) = variants.known.iter().find(|(known, _)| *known == value) {
            return Some(Ok(ask(known)));
        }
        let read = (variants.read)(value).map(|mut other| {
            for (other, own) in other.estimators.list.iter_mut().zip(&self.estimators.list) {
                other.order = own.order;
            }
            ask(&other)
        });
        let needs = "a case that can be read at this value of the sweep";
        Some(read.map_err(|faults| {
            let found = faults.first().map_or_else(String::new, |fault| fault.message.clone());
            Refusal::mismatch(needs, found)
        }))
    }

    /// The distance that each channel of a draw is about.
    pub fn distances(&self) -> Vec<f64> {
        self.problem.distances()
    }

    /// How many estimators are listed.
    pub fn estimators(&self) -> usize {
        self.estimators.list.len()
    }

    /// Draws by a kernel, whatever the case says, where an estimator has it.
    pub fn draw_by(&mut self, order: Order) {
        for estimator in &mut self.estimators.list {
            estimator.order = order;
        }
        for (_, known) in self.variants.iter_mut().flat_map(|variants| &mut variants.known) {
            known.draw_by(order);
        }
    }

    /// Whether an estimator depends on a swept quantity.
    pub fn depends_on(&self, estimator: usize, what: What) -> bool {
        let parsed = &self.estimators.list[estimator];
        let inputs = parsed.features.inputs;
        match what {
            What::Sampling => inputs.sampling && parsed.sampling.is_none(),
            What::SamplingScale => inputs.sampling,
            What::Albedo => self.problem.has_albedo(estimator),
            What::Control => inputs.control && parsed.control.is_none(),
            What::Points => {
                let control = self.estimators.given_control(parsed);
                control.is_some_and(|control| control.with_points(2).is_some())
            }
            What::Density | What::AlbedoScale | What::Contrast => true,
        }
    }

    /// Whether the case declares an estimator biased.
    pub fn expects_bias(&self, estimator: usize) -> bool {
        self.estimators.list[estimator].expect_biased
    }

    /// Prepares an experiment; pilot rays find their random numbers at `address`.
    ///
    /// # Errors
    ///
    /// Why it cannot be drawn.
    pub fn prepare(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
    ) -> Result<Ready, Refusal> {
        let prepared = self.varied(variation, |other| other.prepare(estimator, None, address));
        if let Some(prepared) = prepared {
            return prepared?;
        }
        let (parts, setup_lookups) = self.counted_parts(estimator, variation, None, address)?;
        let parsed = &self.estimators.list[estimator];
        let mut ready =
            self.problem.prepare(estimator, parts, parsed.order(), parsed.expect_biased)?;
        ready.prediction.setup_lookups = setup_lookups;
        refuse_what_cannot_be_computed(ready)
    }

    /// What theory says of an experiment, with `what_if` of that constant σ̂ in place of its own;
    /// `None` if it is refused.
    pub fn predict(
        &self,
        estimator: usize,
        variation: Variation,
        what_if: Option<f64>,
        pilots: Address,
    ) -> Option<Prediction> {
        let ask = |other: &Self| other.predict(estimator, None, what_if, pilots);
        if let Some(predicted) = self.varied(variation, ask) {
            return predicted.ok()?;
        }
        let (parts, setup_lookups) =
            self.counted_parts(estimator, variation, what_if, pilots).ok()?;
        let order = self.estimators.list[estimator].order();
        let prediction = self.problem.predict(estimator, parts, order)?;
        Some(Prediction { setup_lookups, ..prediction })
    }

    /// The ray seen from the side and the places where the control was fitted, for estimators of a
    /// curve.
    pub fn ray_view(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
    ) -> Option<(RayView, Vec<[f64; 2]>)> {
        if let Some(view) = self.varied(variation, |other| other.ray_view(estimator, None, address))
        {
            return view.ok()?;
        }
        let parts = self.parts(estimator, variation, None, address).ok()?;
        let ray_view = self.problem.ray_view(estimator, parts, address)?;
        let site = self.site(address);
        let points = self.with_control(estimator, variation, |recipe| recipe.points(&site));
        Some((ray_view, points))
    }

    /// σ_t, control and σ̂ of each channel along the ray, and at the place of interest.
    pub fn courses(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
        at: Option<f64>,
    ) -> Vec<Course> {
        let ask = |other: &Self| other.courses(estimator, None, address, at);
        if let Some(courses) = self.varied(variation, ask) {
            return courses.unwrap_or_default();
        }
        let parts = self.parts(estimator, variation, None, address).ok();
        let sampling = parts.as_ref().map(|parts| {
            let further = parts.further.iter().map(|(_, sampling)| sampling.as_ref());
            std::iter::once(parts.sampling.as_ref()).chain(further).collect::<Vec<_>>()
        });
        let control = parts.as_ref().map(|parts| &parts.control);
        let media = self.problem.media().iter().enumerate();
        let fields = media.map(|(channel, medium)| Fields {
            medium,
            control,
            sampling: sampling.as_ref().and_then(|all| *all.get(channel)?),
        });
        fields.filter_map(|fields| fields.course(at)).collect()
    }

    /// The largest `|σ_t − σ_c|` on the ray, 1/length: the natural scale of σ̂ for an estimator.
    pub fn natural_scale(&self, estimator: usize, variation: Variation) -> f64 {
        if let Some(scale) = self.varied(variation, |other| other.natural_scale(estimator, None)) {
            return scale.unwrap_or_default();
        }
        let parts = self.parts(estimator, variation, None, NOWHERE);
        let control = parts.and_then(|parts| self.problem.fitting_control(estimator, parts));
        let Ok(control) = control else { return 0.0 };
        let largest = self.mesh().largest(|t, sigma| (sigma - control.extinction(t)).abs());
        largest.map_or(0.0, |(_, size)| size)
    }

    /// Prepares the `Setup<P>` of an experiment, for draws that are made outside the catalogue.
    ///
    /// # Errors
    ///
    /// Why it cannot be drawn.
    pub fn setup(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
    ) -> Result<Box<dyn Any>, Refusal> {
        if let Some(setup) = self.varied(variation, |other| other.setup(estimator, None, address)) {
            return setup?;
        }
        self.problem.setup(estimator, self.parts(estimator, variation, None, address)?)
    }

    fn mesh(&self) -> &Arc<Mesh> {
        &self.meshes()[0]
    }

    fn meshes(&self) -> &[Arc<Mesh>] {
        let cut = |medium: &Medium| Arc::new(Mesh::new(medium.clone()));
        self.meshes.get_or_init(|| self.problem.media().iter().map(cut).collect())
    }

    fn site(&self, address: Address) -> Site<'_> {
        Site { body: &self.body.channels()[0], mesh: self.mesh(), address }
    }

    /// Calls `f` with the control that an experiment uses.
    fn with_control<T>(
        &self,
        estimator: usize,
        variation: Variation,
        f: impl FnOnce(&dyn controls::Recipe) -> T,
    ) -> T {
        let parsed = &self.estimators.list[estimator];
        let varied = match variation {
            Some((What::Points, points)) => self
                .estimators
                .given_control(parsed)
                .and_then(|control| control.with_points(whole(points))),
            Some((What::Control, value)) if self.depends_on(estimator, What::Control) => {
                Some(Box::new(controls::constant::Constant { value }) as Box<dyn controls::Recipe>)
            }
            _ => None,
        };
        f(varied.as_deref().unwrap_or(self.estimators.control_of(parsed)))
    }

    /// What an experiment works on, at a constant σ̂ where one is given.
    fn parts(
        &self,
        estimator: usize,
        variation: Variation,
        what_if: Option<f64>,
        address: Address,
    ) -> Result<Parts<'_>, Refusal> {
        self.counted_parts(estimator, variation, what_if, address).map(|(parts, _)| parts)
    }

    /// Parts of an experiment, and the number of lookups of σ_t that control and σ̂ took.
    fn counted_parts(
        &self,
        estimator: usize,
        variation: Variation,
        what_if: Option<f64>,
        address: Address,
    ) -> Result<(Parts<'_>, u64), Refusal> {
        let (mesh, site) = (self.mesh(), self.site(address));
        let (control, explored) = self.with_control(estimator, variation, |recipe| {
            // Nothing is looked up on a ray that misses the medium.
            let lookups = if mesh.support().is_empty() { 0 } else { recipe.lookups() };
            recipe.prepare(&site).map(|control| (control, lookups as u64))
        })?;
        let (constant, factor) = match variation {
            _ if what_if.is_some() => (what_if, 1.0),
            Some((What::Sampling, value)) => (Some(value), 1.0),
            Some((What::SamplingScale, factor)) => (None, factor),
            _ => (None, 1.0),
        };
        let constant =
            constant.filter(|_| self.estimators.list[estimator].features.inputs.sampling);
        let recipe = self.estimators.sampling_of(&self.estimators.list[estimator]);
        let mut lookups = explored;
        let mut sampling_of = |channel: usize, site: &Site| {
            let (sampling, learned) = match (constant, recipe) {
                (Some(value), _) => (Piecewise::constant(value, mesh.support()), 0),
                (None, Some(recipe)) => {
                    let own = recipe.channels().get(channel).map_or(recipe, |own| &**own);
                    own.prepare_counted(site, &control)?
                }
                (None, None) => return Ok(None),
            };
            lookups += learned;
            Ok(Some(sampling.scaled(factor)))
        };
        let sampling = sampling_of(0, &site)?;
        let channels = self.meshes().iter().zip(self.body.channels()).enumerate().skip(1);
        let further = channels
            .map(|(channel, (mesh, body))| {
                Ok((mesh.clone(), sampling_of(channel, &Site { body, mesh, address })?))
            })
            .collect::<Result<_, Refusal>>()?;
        let albedo = match variation {
            Some((What::Albedo, albedo)) => Some(albedo),
            _ => None,
        };
        let parts = Parts { mesh, sampling, further, control, constant, recipe, factor, albedo };
        Ok((parts, lookups))
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a checked count
fn whole(points: f64) -> usize {
    points as usize
}

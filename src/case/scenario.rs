//! Problem with its medium and the estimators of a case; and, at one value of the sweep, the names, predictions and
//! preparation of its experiments.

use std::sync::{Arc, OnceLock};

use crate::case::Case;
use crate::case::build::{AnyProblem, ProblemKind, Ready, refuse_what_cannot_be_computed};
use crate::case::course::{ChannelFields, Course};
use crate::case::estimator::{Defaults, Estimators};
use crate::case::id::{EstimatorName, ExperimentId, Number, SamplingName, SweepPoint};
use crate::case::sweep::{SweptQuantity, Variation};
use estimators::recipes::{controls, sampling};
use estimators::setup::Parts;
use estimators::trial::Joined;
use estimators::{DrawBuffer, Knowledge, RayView, Refusal, Site};
use media::body::RayNeed;
use media::catalogue::Settings;
use media::{Body, Control, Medium, Piecewise, Volume, misses};
use numeric::rng::Address;
use theory::collisions::Collisions;
use theory::problems::Transmittance;
use theory::{Mesh, Prediction};

/// Address of pilot rays for predictions alone: these need no random numbers, but recipes that learn σ̂ do.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// Problem with its medium and estimators, which are numbered in the order of the case.
pub struct Scenario {
    body: Body,
    problem: Box<dyn AnyProblem>,
    /// Mesh of each channel.
    meshes: OnceLock<Vec<Arc<Mesh>>>,
    /// Coarse mesh of a transmittance of one channel, if it has one.
    coarse: OnceLock<Option<Arc<Mesh>>>,
    estimators: Estimators,
    /// σ̂ that each estimator's recipe makes, by channel, where neither pilot rays nor a sweep change it.
    made: Vec<OnceLock<Vec<Piecewise>>>,
    /// Requirement of the problem on the ray.
    ray: RayNeed,
}

impl Scenario {
    /// Reads the settings after the field: σ̂ and control for all, and the estimators.
    pub(super) fn read(
        kind: &ProblemKind,
        settings: &Settings,
        body: Option<&Body>,
        defaults: Defaults,
    ) -> Option<Self> {
        // A sweep that could not be read may have been one of σ̂.
        let unread = settings.has("sweep") && defaults.swept.is_none();
        let sampling =
            settings.has("sampling") || defaults.swept == Some(SweptQuantity::Sampling) || unread;
        let built = (kind.build)(body, settings, Defaults { sampling, ..defaults });
        let ((problem, estimators), body) = (built?, body?.clone());
        let made = estimators.list.iter().map(|_| OnceLock::new()).collect();
        let (meshes, coarse) = (OnceLock::new(), OnceLock::new());
        Some(Self { body, problem, meshes, coarse, estimators, made, ray: kind.ray })
    }

    /// Returns the field as the case gives it.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Returns the problem, if it is a `P`.
    pub fn problem<P: 'static>(&self) -> Option<&P> {
        self.problem.problem().downcast_ref()
    }

    /// Returns the field of each channel along the ray.
    pub fn media(&self) -> &[Medium] {
        self.problem.media()
    }

    /// Returns the distance that each channel of a draw belongs to.
    pub fn distances(&self) -> Vec<f64> {
        self.problem.distances()
    }

    /// Returns the number of estimators.
    pub fn estimators(&self) -> usize {
        self.estimators.list.len()
    }

    /// Returns notes about doubtful settings of the medium and its ray, a sentence each.
    pub fn notes(&self) -> Vec<String> {
        misses::notes(&self.body, self.ray)
    }

    /// Returns the field's name in the catalogue.
    pub fn medium(&self) -> &str {
        self.body.name()
    }

    /// Returns whether an estimator depends on a swept quantity.
    pub fn depends_on(&self, estimator: usize, what: SweptQuantity) -> bool {
        let parsed = &self.estimators.list[estimator];
        let inputs = parsed.traits.inputs;
        match what {
            SweptQuantity::Sampling => inputs.sampling && parsed.sampling.is_none(),
            SweptQuantity::SamplingScale => inputs.sampling,
            SweptQuantity::Albedo => self.problem.has_albedo(estimator),
            SweptQuantity::Control => inputs.control && parsed.control.is_none(),
            SweptQuantity::Points => {
                let control = self.estimators.given_control(parsed);
                control.is_some_and(|control| control.with_points(2).is_some())
            }
            SweptQuantity::Density | SweptQuantity::AlbedoScale | SweptQuantity::Contrast => true,
        }
    }

    /// Returns whether the case declares an estimator biased.
    pub fn expects_bias(&self, estimator: usize) -> bool {
        self.estimators.list[estimator].expect_biased
    }

    /// Returns the rule of an estimator at a collision, if a draw is a product of its factors.
    pub fn collisions(&self, estimator: usize) -> Option<Collisions> {
        self.estimators.list[estimator].traits.collisions
    }

    /// Returns whether an estimator learns its σ̂ by lookups at random places.
    pub fn learns(&self, estimator: usize) -> bool {
        let recipe = self.estimators.sampling_of(&self.estimators.list[estimator]);
        recipe.is_some_and(sampling::Recipe::learns)
    }

    /// Returns whether σ̂ of an estimator is a majorant of each part of the ray or the volume.
    pub fn is_local(&self, estimator: usize) -> bool {
        let recipe = self.estimators.sampling_of(&self.estimators.list[estimator]);
        recipe.is_some_and(sampling::Recipe::is_local)
    }

    fn mesh(&self) -> &Arc<Mesh> {
        &self.meshes()[0]
    }

    fn meshes(&self) -> &[Arc<Mesh>] {
        let cut = |medium: &Medium| Arc::new(Mesh::new(medium.clone()));
        self.meshes.get_or_init(|| self.problem.media().iter().map(cut).collect())
    }

    fn coarse(&self) -> Option<&Arc<Mesh>> {
        self.problem::<Transmittance>()?;
        self.coarse.get_or_init(|| self.mesh().coarse().map(Arc::new)).as_ref()
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
            Some((SweptQuantity::Points, points)) => {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                // a checked count
                let points = points as usize;
                self.estimators
                    .given_control(parsed)
                    .and_then(|control| control.with_points(points))
            }
            Some((SweptQuantity::Control, value))
                if self.depends_on(estimator, SweptQuantity::Control) =>
            {
                Some(Box::new(controls::constant::Constant { value }) as Box<dyn controls::Recipe>)
            }
            _ => None,
        };
        f(varied.as_deref().unwrap_or(self.estimators.control_of(parsed)))
    }

    /// Returns the parts of an experiment, with σ̂ = `what_if` if that is given, and the number of lookups of σ_t for
    /// control and σ̂.
    fn parts(
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
            Some((SweptQuantity::Sampling, value)) => (Some(value), 1.0),
            Some((SweptQuantity::SamplingScale, factor)) => (None, factor),
            _ => (None, 1.0),
        };
        let parsed = &self.estimators.list[estimator];
        let recipe = self.estimators.sampling_of(parsed);
        let constant = constant.filter(|_| parsed.traits.inputs.sampling);
        let constant = constant.map(|value| sampling::constant::Constant { value });
        let is_control_varied =
            matches!(variation, Some((SweptQuantity::Points | SweptQuantity::Control, _)));
        let is_fixed = constant.is_none()
            && !is_control_varied
            && !recipe.is_some_and(sampling::Recipe::learns);
        let made = Some(&self.made[estimator]).filter(|_| is_fixed);
        let mut lookups = explored;
        let channels = self.meshes().iter().zip(self.body.channels()).enumerate();
        let channels = channels.map(|(channel, (mesh, body))| {
            let own = recipe.map(|recipe| sampling::of_channel(recipe, channel));
            let Some(recipe) = constant.as_ref().map(|own| own as _).or(own) else {
                return Ok((mesh.clone(), None));
            };
            if let Some(known) = made.and_then(OnceLock::get) {
                return Ok((mesh.clone(), Some(known[channel].clone())));
            }
            let site = Site { body, mesh, address };
            let (sampling, learned) = recipe.prepare_counted(&site, &control)?;
            lookups += learned;
            Ok((mesh.clone(), Some(sampling)))
        });
        let mut channels: Vec<(Arc<Mesh>, Option<Piecewise>)> =
            channels.collect::<Result<_, Refusal>>()?;
        if let Some(made) = made.filter(|_| recipe.is_some()) {
            made.get_or_init(|| channels.iter().filter_map(|channel| channel.1.clone()).collect());
        }
        for (_, sampling) in &mut channels {
            *sampling = sampling.take().map(|sampling| sampling.scaled(factor));
        }
        let space = Box::new(move |volume: &Volume| {
            let recipe = constant.as_ref().map(|own| own as _).or(recipe);
            Ok(Arc::new(sampling::in_space(recipe, volume)?.scaled(factor)))
        });
        let albedo = match variation {
            Some((SweptQuantity::Albedo, albedo)) => Some(albedo),
            _ => None,
        };
        Ok((Parts { channels, control, space, albedo, distributions: false }, lookups))
    }
}

/// Case at one value of its sweep.
pub struct ScenarioAtPoint<'a> {
    case: &'a Case,
    scenario: ScenarioSource<'a>,
    /// Point of the sweep.
    swept: Variation,
}

/// Scenario of the case, or one that was read for a value beside its sweep.
pub(super) enum ScenarioSource<'a> {
    Listed(&'a Scenario),
    Beside(Box<Scenario>),
}

impl<'a> ScenarioAtPoint<'a> {
    /// Takes a scenario of the case at a point of the sweep.
    pub(super) fn new(case: &'a Case, scenario: ScenarioSource<'a>, swept: Variation) -> Self {
        Self { case, scenario, swept }
    }

    /// Returns the medium and the estimators.
    pub fn scenario(&self) -> &Scenario {
        match &self.scenario {
            ScenarioSource::Listed(scenario) => scenario,
            ScenarioSource::Beside(scenario) => scenario,
        }
    }

    /// Returns the swept quantity with its value, unless the medium is swept: the scenario already has that.
    fn variation(&self) -> Variation {
        self.swept.filter(|(what, _)| !what.varies_medium())
    }

    /// Returns the identity of an experiment. Identities that agree in all else, such as those of two estimators with
    /// fields as controls, are numbered.
    pub fn id(&self, estimator: usize) -> ExperimentId {
        let own = self.unnumbered(estimator);
        let earlier = (0..estimator).filter(|&other| self.unnumbered(other) == own).count();
        ExperimentId { namesake: earlier + 1, ..own }
    }

    /// Returns the identity of an experiment before it is numbered.
    pub(super) fn unnumbered(&self, estimator: usize) -> ExperimentId {
        let (scenario, variation) = (self.scenario(), self.variation());
        let parsed = &scenario.estimators.list[estimator];
        let (constant, kind) = match (variation, scenario.estimators.sampling_of(parsed)) {
            (Some((SweptQuantity::Sampling, value)), _)
                if scenario.depends_on(estimator, SweptQuantity::Sampling) =>
            {
                (Some(value), "constant".into())
            }
            (Some((SweptQuantity::SamplingScale, factor)), Some(recipe)) => {
                let kind = format!("{factor} × {}", recipe.label());
                (recipe.constant().map(|value| value * factor), kind)
            }
            (_, Some(recipe)) => (recipe.constant(), recipe.label()),
            (_, None) => (None, String::new()),
        };
        ExperimentId {
            case: self.case.name.clone(),
            problem: self.case.problem.clone(),
            estimator: parsed.label(!matches!(variation, Some((SweptQuantity::Albedo, _)))),
            sampling: SamplingName { constant: constant.map(Number), kind },
            control: scenario.with_control(estimator, variation, |recipe| recipe.label()),
            swept: self.swept.map(|(what, value)| SweepPoint { what, value: Number(value) }),
            namesake: 1,
        }
    }

    /// Returns the name of the estimator that an experiment equals by definition, if there is one.
    pub(super) fn alias(&self, estimator: usize) -> Option<EstimatorName> {
        let ExperimentId { sampling, control, .. } = self.unnumbered(estimator);
        let is_plain = control.is_empty() && sampling.constant.is_some();
        self.scenario().estimators.list[estimator].alias().filter(|_| is_plain)
    }

    /// Returns the knowledge of the medium that an experiment needs beside lookups.
    pub fn needs(&self, estimator: usize) -> Vec<Knowledge> {
        let (scenario, variation) = (self.scenario(), self.variation());
        let parsed = &scenario.estimators.list[estimator];
        let control = scenario.with_control(estimator, variation, |recipe| recipe.needs());
        // A swept σ̂ replaces the recipe.
        let is_swept = matches!(variation, Some((SweptQuantity::Sampling, _)));
        let recipe = scenario.estimators.sampling_of(parsed);
        let recipe = recipe
            .filter(|_| !(is_swept && scenario.depends_on(estimator, SweptQuantity::Sampling)));
        let own = parsed.traits.needs.filter(|own| control != Some(*own));
        let needs = [own, control, recipe.and_then(sampling::Recipe::needs)];
        needs.into_iter().flatten().collect()
    }

    /// Returns the parts of an experiment, with σ̂ = `what_if` if that is given, and the number of lookups that made them.
    fn parts(
        &self,
        estimator: usize,
        what_if: Option<f64>,
        pilots: Address,
    ) -> Result<(Parts<'_>, u64), Refusal> {
        self.scenario().parts(estimator, self.variation(), what_if, pilots)
    }

    /// Joins an estimator with its setup; pilot rays take their random numbers at `pilots`. Draws outside its domain have no
    /// prediction.
    ///
    /// # Errors
    ///
    /// Why it cannot be drawn.
    pub fn join(&self, estimator: usize, pilots: Address) -> Result<Box<dyn Joined>, Refusal> {
        let (parts, _) = self.parts(estimator, None, pilots)?;
        self.scenario().problem.join(estimator, parts)
    }

    /// Prepares an experiment as [`ScenarioAtPoint::join`] does, with its prediction.
    ///
    /// # Errors
    ///
    /// Why it cannot be drawn.
    pub fn prepare(&self, estimator: usize, pilots: Address) -> Result<Ready, Refusal> {
        let scenario = self.scenario();
        let (parts, setup_lookups) = self.parts(estimator, None, pilots)?;
        let joined = scenario.problem.join(estimator, Parts { distributions: true, ..parts })?;
        let prediction = match joined.domain() {
            Ok(()) => joined.predict(),
            // A declared bias: outside the domain the formulas do not hold, only the truth does.
            Err(_) if scenario.expects_bias(estimator) => joined.predict().only_the_truth(),
            Err(refusal) => return Err(refusal),
        };
        let prediction = Prediction { setup_lookups, ..prediction };
        refuse_what_cannot_be_computed(Ready { experiment: joined, prediction })
    }

    /// Makes the first draws of an estimator: those of a run with this seed. Their unit is `exp(−log_unit)` of their
    /// channel's prediction: 1, unless τ is so large that T would underflow.
    ///
    /// # Errors
    ///
    /// Why it cannot be drawn.
    ///
    /// # Panics
    ///
    /// On processors that lack what kernels are compiled for, see [`numeric::fused::missing`].
    pub fn draws(&self, estimator: usize, seed: u64, count: usize) -> Result<DrawBuffer, Refusal> {
        let ready = self.prepare(estimator, self.case.pilots(seed, estimator))?;
        let address = self.id(estimator).address(seed, self.alias(estimator).as_ref());
        Ok(ready.draws(address, count))
    }

    /// Predicts an experiment, with σ̂ = `what_if` if that is given, without distributions; `None` if it is refused.
    pub fn predict(
        &self,
        estimator: usize,
        what_if: Option<f64>,
        pilots: Address,
    ) -> Option<Prediction> {
        self.predict_by(estimator, self.parts(estimator, what_if, pilots).ok()?)
    }

    fn predict_by(
        &self,
        estimator: usize,
        (parts, setup_lookups): (Parts, u64),
    ) -> Option<Prediction> {
        let joined = self.scenario().problem.join(estimator, parts).ok()?;
        joined.domain().ok()?;
        Some(Prediction { setup_lookups, ..joined.predict() })
    }

    /// Predicts an experiment as [`ScenarioAtPoint::predict`] does, to a few thousandths, in less time where the medium has many pieces.
    pub fn estimate(&self, estimator: usize, pilots: Address) -> Option<Prediction> {
        let Some(mesh) = self.scenario().coarse() else {
            return self.predict(estimator, None, pilots);
        };
        let mut parts = self.parts(estimator, None, pilots).ok()?;
        parts.0.channels[0].0 = mesh.clone();
        // Where the coarse mesh refuses, the fine one decides.
        let actual = self.predict_by(estimator, parts);
        let actual = actual.filter(|actual| actual.channels[0].resolved_moments().is_some());
        actual.or_else(|| self.predict(estimator, None, pilots))
    }

    /// Returns the control of an experiment; `None` where it cannot be made.
    pub fn control(&self, estimator: usize, pilots: Address) -> Option<Control> {
        self.parts(estimator, None, pilots).ok().map(|(parts, _)| parts.control)
    }

    /// Returns the ray seen from the side and the places where the control was fitted, for estimators of a curve.
    pub fn ray_view(&self, estimator: usize, address: Address) -> Option<(RayView, Vec<[f64; 2]>)> {
        let ray_view = self.join(estimator, address).ok()?.ray_view(address)?;
        let (scenario, variation) = (self.scenario(), self.variation());
        let site = scenario.site(address);
        let points = scenario.with_control(estimator, variation, |recipe| recipe.points(&site));
        Some((ray_view, points))
    }

    /// Returns σ_t, control and σ̂ of each channel along the ray, and at the place of interest. Places where a field
    /// has no finite value are left out.
    pub fn courses(&self, estimator: usize, address: Address, at: Option<f64>) -> Vec<Course> {
        let scenario = self.scenario();
        let parts = self.parts(estimator, None, address).ok();
        let parts = parts.as_ref().map(|(parts, _)| parts);
        let media = scenario.media().iter().enumerate();
        let fields = media.map(|(channel, medium)| ChannelFields {
            medium,
            control: parts.map(|parts| &parts.control),
            sampling: parts.and_then(|parts| parts.channels[channel].1.as_ref()),
        });
        fields.filter_map(|fields| fields.course(at)).map(Course::finite).collect()
    }

    /// Returns the largest `|σ_t − σ_c|` on the ray, 1/length: the natural scale of σ̂ for an estimator.
    pub fn natural_scale(&self, estimator: usize) -> f64 {
        let scenario = self.scenario();
        let Ok((parts, _)) = self.parts(estimator, None, NOWHERE) else { return 0.0 };
        let control = parts.control.clone();
        if scenario.problem.join(estimator, parts).is_err() {
            return 0.0;
        }
        let largest = scenario.mesh().largest(&|t, sigma| (sigma - control.extinction(t)).abs());
        largest.map_or(0.0, |(_, size)| size)
    }
}

//! A problem with its medium and the estimators of a case, and the parts of their experiments.

use std::sync::{Arc, OnceLock};

use crate::case::build::{AnyProblem, Parts, ProblemKind};
use crate::case::estimator::{Defaults, Estimators};
use crate::case::sweep::{Variation, What};
use estimators::recipes::controls;
use estimators::{Order, Refusal, Site};
use media::body::RayNeed;
use media::catalogue::Settings;
use media::{Body, Medium, Piecewise, misses};
use numeric::rng::Address;
use theory::Mesh;

/// A problem with its medium and estimators, which are numbered in the order of the case.
pub struct Scenario {
    body: Body,
    pub(super) problem: Box<dyn AnyProblem>,
    /// Mesh of each channel.
    meshes: OnceLock<Vec<Arc<Mesh>>>,
    pub(super) estimators: Estimators,
    /// Requirement of the problem on the ray.
    ray: RayNeed,
}

impl Scenario {
    /// Reads what follows the field: σ̂ and control for all, and the estimators.
    pub(super) fn read(
        kind: &ProblemKind,
        settings: &Settings,
        body: Option<&Body>,
        defaults: Defaults,
    ) -> Option<Self> {
        // A sweep that could not be read may have been one of σ̂.
        let unread = settings.has("sweep") && defaults.swept.is_none();
        let sampling = settings.has("sampling") || defaults.swept == Some(What::Sampling) || unread;
        let built = (kind.build)(body, settings, Defaults { sampling, ..defaults });
        let ((problem, estimators), body) = (built?, body?.clone());
        Some(Self { body, problem, meshes: OnceLock::new(), estimators, ray: kind.ray })
    }

    /// The field as the case gives it.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// The problem, if it is a `P`.
    pub fn problem<P: 'static>(&self) -> Option<&P> {
        self.problem.problem().downcast_ref()
    }

    /// The field of each channel along the ray.
    pub fn media(&self) -> &[Medium] {
        self.problem.media()
    }

    /// The distance that each channel of a draw is about.
    pub fn distances(&self) -> Vec<f64> {
        self.problem.distances()
    }

    /// Number of estimators.
    pub fn estimators(&self) -> usize {
        self.estimators.list.len()
    }

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

    /// Draws by a kernel where an estimator has it, estimator by estimator.
    pub(super) fn draw_by(&mut self, order: impl Fn(usize) -> Order) {
        for (number, estimator) in self.estimators.list.iter_mut().enumerate() {
            estimator.order = order(number);
        }
    }

    /// Kernel that the case asks for.
    pub(super) fn wished_order(&self, estimator: usize) -> Order {
        self.estimators.list[estimator].order
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

    pub(super) fn mesh(&self) -> &Arc<Mesh> {
        &self.meshes()[0]
    }

    fn meshes(&self) -> &[Arc<Mesh>] {
        let cut = |medium: &Medium| Arc::new(Mesh::new(medium.clone()));
        self.meshes.get_or_init(|| self.problem.media().iter().map(cut).collect())
    }

    pub(super) fn site(&self, address: Address) -> Site<'_> {
        Site { body: &self.body.channels()[0], mesh: self.mesh(), address }
    }

    /// Calls `f` with the control that an experiment uses.
    pub(super) fn with_control<T>(
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

    /// Parts of an experiment, at a constant σ̂ if one is given.
    pub(super) fn parts(
        &self,
        estimator: usize,
        variation: Variation,
        what_if: Option<f64>,
        address: Address,
    ) -> Result<Parts<'_>, Refusal> {
        self.counted_parts(estimator, variation, what_if, address).map(|(parts, _)| parts)
    }

    /// Parts of an experiment, and the number of lookups of σ_t that control and σ̂ took.
    pub(super) fn counted_parts(
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

//! Turns the settings of a spec into experiments that can be drawn: a problem and its estimators without their types.
//! An experiment that a program with doubles cannot test within a lifetime is refused.

use std::any::Any;
use std::sync::Arc;

use crate::case::estimator::{Defaults, Estimators};
use estimators::setup::{FAINTEST, Parts};
use estimators::trial::{Entry, Joined};
use estimators::{DrawBuffer, Estimated, Experiment, Fields, Refusal, Setup};
use gate::stats::verdict::BLOCK;
use media::body::RayNeed;
use media::catalogue::Settings;
use media::{Body, Medium};
use numeric::rng::Address;
use theory::Prediction;
use theory::problems::options::chosen;
use theory::problems::{ProblemOption, each_problem};

/// Largest expected number of lookups of a draw; more are a mistake in the case.
const MAX_LOOKUPS: f64 = 1e6;

/// An experiment that can be drawn.
pub struct Ready {
    /// Draws of the estimator.
    pub experiment: Box<dyn Experiment>,
    /// Prediction. For a forced experiment the moments do not hold and are removed.
    pub prediction: Prediction,
}

impl Ready {
    /// Makes the first draws from an address on, block after block.
    pub fn draws(&self, address: Address, count: usize) -> DrawBuffer {
        #[allow(clippy::cast_possible_truncation)] // 2¹⁴
        let length = BLOCK as usize;
        let channels = self.prediction.channels.len();
        let (mut all, mut block) = (DrawBuffer::new(channels), DrawBuffer::new(channels));
        for (number, start) in (0..count).step_by(length).enumerate() {
            let mut streams = Address { block: number as u64, ..address }.streams();
            self.experiment.fill(&mut streams, (count - start).min(length), &mut block);
            all.append(&block);
        }
        all
    }
}

/// Form of a problem of the catalogue, before a case is read.
pub struct ProblemKind {
    /// Options that choose the form.
    pub options: &'static [ProblemOption],
    /// Requirement on the ray through a volume.
    pub ray: RayNeed,
    /// True if its medium may have several channels.
    pub spectral: bool,
    /// Reader of the problem and its estimators.
    pub build: Build,
}

/// Reads a problem and its estimators; `None` after a mistake.
pub type Build =
    fn(Option<&Body>, &Settings, Defaults) -> Option<(Box<dyn AnyProblem>, Estimators)>;

/// Returns the form that settings ask for, of the problem at a position of the catalogue; `None` after a mistake.
pub fn kind(index: usize, settings: &Settings) -> Option<ProblemKind> {
    let mut forms = each_problem!(ProblemKind::of).into_iter().nth(index)?;
    let options: Vec<_> = forms.iter().map(|form| form.options).collect();
    Some(forms.swap_remove(chosen(&options, settings)?))
}

impl ProblemKind {
    fn of<P: Estimated>() -> Self {
        Self { options: P::OPTIONS, ray: P::RAY, spectral: P::SPECTRAL, build: build::<P> }
    }
}

fn build<P: Estimated>(
    body: Option<&Body>,
    settings: &Settings,
    defaults: Defaults,
) -> Option<(Box<dyn AnyProblem>, Estimators)> {
    let problem = P::read(body, settings).map(Arc::new);
    let (estimators, entries) = Estimators::read::<P>(settings, body, defaults)?;
    Some((Box::new(Typed { problem: problem?, entries }), estimators))
}

/// A problem with the estimators of a case; estimators are numbered in the order of the case.
pub trait AnyProblem: Send + Sync {
    /// Returns the problem, of its own type.
    fn problem(&self) -> &dyn Any;

    /// Returns the field of each channel along the ray.
    fn media(&self) -> &[Medium];

    /// Returns the distance that each channel of a draw belongs to.
    fn distances(&self) -> Vec<f64>;

    /// Returns whether an estimator, or the problem itself, depends on an albedo.
    fn has_albedo(&self, estimator: usize) -> bool;

    /// Joins an estimator with its setup, at the swept albedo where it has one.
    fn join(&self, estimator: usize, parts: Parts) -> Result<Box<dyn Joined>, Refusal>;
}

/// A problem of known type with its estimators.
struct Typed<P> {
    problem: Arc<P>,
    entries: Vec<Box<dyn Entry<P>>>,
}

impl<P: Estimated> AnyProblem for Typed<P> {
    fn problem(&self) -> &dyn Any {
        &*self.problem
    }

    fn media(&self) -> &[Medium] {
        self.problem.media()
    }

    fn distances(&self) -> Vec<f64> {
        self.problem.distances()
    }

    fn has_albedo(&self, estimator: usize) -> bool {
        let own = self.entries[estimator].traits().albedo;
        own.is_some() || self.problem.with_albedo(0.5).is_some()
    }

    fn join(&self, estimator: usize, parts: Parts) -> Result<Box<dyn Joined>, Refusal> {
        let own = &self.entries[estimator];
        let varied = parts.albedo.and_then(|albedo| own.with_albedo(albedo));
        let setup = Setup::new(&self.problem, parts)?;
        // Without collisions a draw does not begin with the weight T_c.
        if own.traits().inputs.sampling {
            setup.fields.require_weights()?;
        }
        Ok(varied.as_ref().unwrap_or(own).join(setup))
    }
}

/// Refuses an experiment if its answer leaves the range of doubles, or if its draws would take too many lookups.
pub(super) fn refuse_what_cannot_be_computed(ready: Ready) -> Result<Ready, Refusal> {
    for channel in &ready.prediction.channels {
        let truth = channel.truth.value;
        let is_known = channel.truth.error.is_finite();
        if !(truth.is_finite() && truth >= FAINTEST && is_known) {
            let needs = "an answer between 1e-300 and infinity";
            let channel = &channel.name;
            let actual = if truth.is_nan() || !is_known {
                format!("theory does not know {channel}")
            } else {
                format!("{channel} is {truth:e}")
            };
            return Err(Refusal::mismatch(needs, actual));
        }
        // The mean of a biased estimator may differ from the truth, which is the unit of all numbers.
        let mean = channel.mean.value;
        if !mean.is_finite() {
            let needs = "draws whose mean is below 1e300 truths";
            return Err(Refusal::mismatch(needs, format!("theory expects {mean:e}")));
        }
    }
    match &ready.prediction.lookups {
        Some(lookups) if lookups.mean.is_nan() || lookups.mean > MAX_LOOKUPS => {
            let needs = "at most a million lookups a draw";
            Err(Refusal::mismatch(needs, format!("theory expects {:e}", lookups.mean)))
        }
        _ => Ok(ready),
    }
}

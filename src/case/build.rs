//! Turns the settings of a spec into experiments that can be drawn: a problem and its estimators without their types.
//! An experiment that a program with doubles cannot test within a lifetime is refused.

use std::any::Any;
use std::sync::Arc;

use crate::case::estimator::{Defaults, Estimators};
use estimators::recipes::sampling;
use estimators::trial::Entry;
use estimators::{Estimated, Experiment, RayView, Refusal, Setup};
use media::body::RayNeed;
use media::catalogue::Settings;
use media::{Body, Control, Medium, Piecewise};
use numeric::digits::rounded;
use numeric::rng::Address;
use theory::problems::options::chosen;
use theory::problems::{self, ProblemOption, each_problem};
use theory::{Mesh, Prediction};

/// Smallest transmittance of which the ratio of a draw to the truth is still a double.
const FAINTEST: f64 = 1e-300;
/// Largest expected number of lookups of a draw; more are a mistake in the case.
const MAX_LOOKUPS: f64 = 1e6;

/// An experiment that can be drawn.
pub struct Ready {
    /// Draws of the estimator.
    pub experiment: Box<dyn Experiment>,
    /// Prediction. For a forced experiment the moments do not hold and are removed.
    pub prediction: Prediction,
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

macro_rules! kinds {
    ($($module:ident: $($Form:ident)*,)*) => {
        [$(vec![$(ProblemKind::of::<problems::$Form>()),*]),*]
    };
}

/// Returns the form that settings ask for, of the problem at a position of the catalogue; `None` after a mistake.
pub fn kind(index: usize, settings: &Settings) -> Option<ProblemKind> {
    let mut forms = each_problem!(kinds).into_iter().nth(index)?;
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

/// Input of an estimator beside its problem.
pub struct Parts<'a> {
    /// The medium, cut into panels.
    pub mesh: &'a Arc<Mesh>,
    /// σ̂ along the ray.
    pub sampling: Option<Piecewise>,
    /// Medium and σ̂ of each channel but the first.
    pub further: Vec<(Arc<Mesh>, Option<Piecewise>)>,
    /// σ_c.
    pub control: Control,
    /// Constant σ̂, 1/length, in place of the recipe's.
    pub constant: Option<f64>,
    /// Recipe of σ̂ in space.
    pub recipe: Option<&'a dyn sampling::Recipe>,
    /// Factor on that σ̂.
    pub factor: f64,
    /// Swept albedo, in place of the one in the case.
    pub albedo: Option<f64>,
}

/// Problem with the estimators of a case; estimators are numbered in the order of the case.
pub trait AnyProblem: Send + Sync {
    /// Returns the problem, of its own type.
    fn problem(&self) -> &dyn Any;

    /// Returns the field of each channel along the ray.
    fn media(&self) -> &[Medium];

    /// Returns the distance that each channel of a draw belongs to.
    fn distances(&self) -> Vec<f64>;

    /// Returns whether an estimator, or the problem itself, depends on an albedo.
    fn has_albedo(&self, estimator: usize) -> bool;

    /// Returns the control of an experiment, if medium, σ̂ and control fit together.
    fn fitting_control(&self, estimator: usize, parts: Parts) -> Result<Control, Refusal>;

    /// Prepares an experiment with its prediction; a `forced` one is drawn outside its domain, too.
    fn prepare(&self, estimator: usize, parts: Parts, forced: bool) -> Result<Ready, Refusal>;

    /// Predicts an experiment, without distributions; `None` if it is refused.
    fn predict(&self, estimator: usize, parts: Parts) -> Option<Prediction>;

    /// Returns the ray seen from the side, for estimators of a curve.
    fn ray_view(&self, estimator: usize, parts: Parts, address: Address) -> Option<RayView>;

    /// Prepares the `Setup<P>` of an experiment, for draws that are made outside the catalogue.
    fn setup(&self, estimator: usize, parts: Parts) -> Result<Box<dyn Any>, Refusal>;
}

/// A problem of known type with its estimators.
struct Typed<P> {
    problem: Arc<P>,
    entries: Vec<Box<dyn Entry<P>>>,
}

impl<P: Estimated> Typed<P> {
    fn joined(&self, estimator: usize, parts: Parts) -> Result<Setup<P>, Refusal> {
        let Parts { mesh, sampling, further, control, constant, recipe, factor, albedo } = parts;
        let varied = albedo.and_then(|albedo| self.problem.with_albedo(albedo));
        let problem = varied.map_or_else(|| self.problem.clone(), Arc::new);
        let entry = &self.entries[estimator];
        let setup = Setup::new(problem, mesh.clone(), sampling, control);
        let setup = if entry.skips() { setup.skipping() } else { setup };
        let setup = if P::SPECTRAL { setup.spectral(further) } else { setup };
        let setup = setup.in_space(constant, recipe, factor)?;
        // Without collisions a draw does not begin with the weight T_c.
        if entry.inputs().sampling {
            let Setup { control, log_unit, control_transmittance, .. } = &setup;
            require_weights(control, mesh, *log_unit, *control_transmittance)?;
        }
        Ok(setup)
    }

    /// Calls `f` with an estimator, at the swept albedo where it has one.
    fn with_entry<T>(
        &self,
        estimator: usize,
        albedo: Option<f64>,
        f: impl FnOnce(&dyn Entry<P>) -> T,
    ) -> T {
        let own = &self.entries[estimator];
        let varied = albedo.and_then(|albedo| own.with_albedo(albedo));
        f(varied.as_deref().unwrap_or(&**own))
    }
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
        let entry = &self.entries[estimator];
        entry.with_albedo(0.5).is_some() || self.problem.with_albedo(0.5).is_some()
    }

    fn fitting_control(&self, estimator: usize, parts: Parts) -> Result<Control, Refusal> {
        self.joined(estimator, parts).map(|setup| setup.control)
    }

    fn prepare(&self, estimator: usize, parts: Parts, forced: bool) -> Result<Ready, Refusal> {
        let albedo = parts.albedo;
        let setup = self.joined(estimator, parts)?;
        self.with_entry(estimator, albedo, |entry| {
            let prediction = match entry.domain(&setup) {
                Ok(()) => entry.predict(&setup),
                // Forced: outside the domain the formulas do not hold, only the truth does.
                Err(_) if forced => entry.predict(&setup).only_the_truth(),
                Err(refusal) => return Err(refusal),
            };
            Ok(Ready { experiment: entry.experiment(setup), prediction })
        })
    }

    fn predict(&self, estimator: usize, parts: Parts) -> Option<Prediction> {
        let albedo = parts.albedo;
        let setup = Setup { laws: false, ..self.joined(estimator, parts).ok()? };
        self.with_entry(estimator, albedo, |entry| {
            entry.domain(&setup).ok()?;
            Some(entry.predict(&setup))
        })
    }

    fn ray_view(&self, estimator: usize, parts: Parts, address: Address) -> Option<RayView> {
        let setup = self.joined(estimator, parts).ok()?;
        self.entries[estimator].ray_view(&setup, address)
    }

    fn setup(&self, estimator: usize, parts: Parts) -> Result<Box<dyn Any>, Refusal> {
        Ok(Box::new(self.joined(estimator, parts)?))
    }
}

/// Refuses a control if its weights `T_c`, in units of `exp(−log_unit)`, leave the range of doubles.
fn require_weights(
    control: &Control,
    mesh: &Mesh,
    log_unit: f64,
    controlled: f64,
) -> Result<(), Refusal> {
    if (FAINTEST..=1.0 / FAINTEST).contains(&controlled) {
        return Ok(());
    }
    if log_unit == 0.0 {
        let needs = "a control with T_c between 1e-300 and 1e300";
        return Err(Refusal::mismatch(needs, format!("T_c = {controlled:e}")));
    }
    let needs = "draws between 1e-300 and 1e300 times T";
    let control = control.optical_depth(mesh.support()).value;
    let [whole, control] = [log_unit, control].map(rounded);
    let found = format!("τ = {whole}, of which the control takes {control}");
    Err(Refusal::mismatch(needs, found))
}

/// Refuses an experiment if its answer leaves the range of doubles, or if its draws would take too many lookups.
pub(super) fn refuse_what_cannot_be_computed(ready: Ready) -> Result<Ready, Refusal> {
    for channel in &ready.prediction.channels {
        let truth = channel.truth.value;
        let is_known = channel.truth.error.is_finite();
        if !(truth.is_finite() && truth >= FAINTEST && is_known) {
            let needs = "an answer between 1e-300 and infinity";
            let channel = &channel.name;
            let found = if truth.is_nan() || !is_known {
                format!("theory does not know {channel}")
            } else {
                format!("{channel} is {truth:e}")
            };
            return Err(Refusal::mismatch(needs, found));
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

//! A problem with its medium and its estimators: where names become types.

use std::sync::{Arc, OnceLock};

use super::computable::{FAINTEST, refuse_what_cannot_be_computed};
use super::mutation::Walk;
use super::sweep::What;
pub use super::written::Names;
use super::written::{Usual, Written, predict, read_if, refuse_idle_controls};
use crate::catalogue::{Settings, rounded};
use crate::estimators::trial::Entry;
use crate::estimators::{Experiment, Order, Portrait, Refusal, Setup, Site, controls, sampling};
use crate::media::{Body, Piecewise};
use crate::mutants::Mutable;
use crate::rng::Address;
use crate::theory::{Mesh, Prediction};

/// One value of a sweep.
pub type Variation = Option<(What, f64)>;

/// Theory needs no random numbers, but recipes that learn from pilot rays do.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// A problem whose type is no longer visible.
pub trait AnyScenario: Send + Sync {
    /// The field's name in the catalogue.
    fn medium(&self) -> &str;

    /// The distance that each channel of a draw is about.
    fn distances(&self) -> Vec<f64>;

    /// How many estimators are written.
    fn estimators(&self) -> usize;

    /// Draws by a kernel, whatever the case says, where an estimator has it.
    fn draw_by(&mut self, order: Order);

    /// Whether an estimator depends on a swept quantity.
    fn depends_on(&self, estimator: usize, what: What) -> bool;

    /// How an experiment is called in tables.
    fn names(&self, estimator: usize, variation: Variation) -> Names;

    /// Prepares an experiment; pilot rays and portraits find their random numbers at `address`.
    fn prepare(&self, estimator: usize, variation: Variation, address: Address) -> Prepared;

    /// What theory says of an experiment; `None` if it is refused.
    ///
    /// With `what_if` of that constant σ̂ in place of its own.
    fn predict(
        &self,
        estimator: usize,
        variation: Variation,
        what_if: Option<f64>,
        pilots: Address,
    ) -> Option<Prediction>;

    /// The ray seen from the side, for estimators of a curve.
    fn portrait(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
    ) -> Option<(Portrait, Vec<[f64; 2]>)>;

    /// The largest `|σ_t − σ_c|` on the ray: the natural scale of σ̂ for an estimator.
    fn natural_scale(&self, estimator: usize, variation: Variation) -> f64;

    /// A mutant in an estimator's place; `None` if the problem has none of that name.
    fn mutated(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
        name: &str,
        walk: Walk,
    ) -> Option<Result<Box<dyn Experiment>, Refusal>>;
}

/// An experiment that can be drawn, or the reason why not.
pub struct Prepared {
    /// The experiment and what theory says of it.
    pub outcome: Result<Ready, Refusal>,
    /// Whether the case declares it biased.
    pub expect_biased: bool,
}

/// An experiment that can be drawn.
pub struct Ready {
    /// What draws.
    pub experiment: Box<dyn Experiment>,
    /// What theory says. For a forced experiment the moments are void and removed.
    pub prediction: Prediction,
}

/// A problem of known type.
pub struct Scenario<P: Mutable> {
    body: Body,
    problem: Arc<P>,
    mesh: OnceLock<Arc<Mesh>>,
    sampling: Option<Box<dyn sampling::Recipe>>,
    control: Option<Box<dyn controls::Recipe>>,
    written: Vec<Written<P>>,
}

impl<P: Mutable> Scenario<P> {
    /// Reads what follows the field: σ̂ and control for all, and the estimators.
    pub fn read(
        settings: &Settings,
        body: Option<&Body>,
        usual: Usual,
        swept: Option<What>,
    ) -> Option<Box<dyn AnyScenario>> {
        let problem = P::read(body, settings);
        let sampling = read_if(settings, "sampling", body, sampling::read);
        let control = read_if(settings, "control", body, controls::read);
        // A sweep that could not be read may have been one of σ̂.
        let unread = settings.has("sweep") && swept.is_none();
        let shared = settings.has("sampling") || swept == Some(What::Sampling) || unread;
        let usual = Usual { sampling: shared, ..usual };
        let estimators = settings.tables("estimators").map(|tables| {
            let read = |table: &Settings| Written::read(table, body, usual);
            tables.iter().map(read).collect::<Vec<_>>()
        });
        let estimators = estimators?;
        if estimators.is_empty() {
            settings.fault(
                "estimators",
                "no estimator is listed",
                "list one, as in { ratio = {} }",
            );
        }
        let written: Option<Vec<Written<P>>> = estimators.into_iter().collect();
        refuse_idle_controls(settings, written.as_deref().unwrap_or_default(), swept);
        Some(Box::new(Self {
            problem: Arc::new(problem?),
            mesh: OnceLock::new(),
            sampling: sampling?,
            control: control?,
            written: written?,
            body: body?.clone(),
        }))
    }

    fn mesh(&self) -> &Arc<Mesh> {
        self.mesh.get_or_init(|| Arc::new(Mesh::new(self.problem.medium().clone())))
    }

    fn control_of(&self, index: usize, variation: Variation) -> Option<Box<dyn controls::Recipe>> {
        let written = &self.written[index];
        if !written.entry.inputs().control {
            return None;
        }
        let own = written.control.as_deref();
        match (own, variation) {
            (Some(own), Some((What::Points, points))) => own.with_points(whole(points)),
            (None, Some((What::Control, value))) => {
                Some(Box::new(controls::constant::Constant { value }))
            }
            (None, Some((What::Points, points))) => {
                self.control.as_deref().and_then(|control| control.with_points(whole(points)))
            }
            _ => None,
        }
    }

    /// Calls `f` with the control that an experiment uses.
    fn with_control<T>(
        &self,
        index: usize,
        variation: Variation,
        f: impl FnOnce(&dyn controls::Recipe) -> T,
    ) -> T {
        let written = &self.written[index];
        if !written.entry.inputs().control {
            return f(&controls::none::None);
        }
        if let Some(varied) = self.control_of(index, variation) {
            return f(varied.as_ref());
        }
        if let Some(own) = written.control.as_deref().or(self.control.as_deref()) {
            return f(own);
        }
        match written.entry.default_control() {
            Some(default) => f(default.as_ref()),
            None => f(&controls::none::None),
        }
    }

    fn sampling_of(&self, index: usize) -> Option<&dyn sampling::Recipe> {
        let written = &self.written[index];
        let wanted = written.entry.inputs().sampling;
        wanted.then(|| written.sampling.as_deref().or(self.sampling.as_deref())).flatten()
    }

    /// The setup of an experiment.
    fn setup(
        &self,
        index: usize,
        variation: Variation,
        address: Address,
    ) -> Result<Setup<P>, Refusal> {
        self.setup_at(index, variation, None, address)
    }

    /// The same, at a constant σ̂ where one is given.
    fn setup_at(
        &self,
        index: usize,
        variation: Variation,
        what_if: Option<f64>,
        address: Address,
    ) -> Result<Setup<P>, Refusal> {
        let site = Site { body: &self.body, mesh: self.mesh(), address };
        let control = self.with_control(index, variation, |recipe| recipe.prepare(&site))?;
        let takes_sampling = self.written[index].entry.inputs().sampling;
        let (constant, factor) = match variation {
            _ if what_if.is_some() => (what_if, 1.0),
            Some((What::Sampling, value)) => (Some(value), 1.0),
            Some((What::SamplingScale, factor)) => (None, factor),
            _ => (None, 1.0),
        };
        let constant = constant.filter(|_| takes_sampling);
        let sampling: Option<Piecewise> = match (constant, self.sampling_of(index)) {
            (Some(value), _) => Some(Piecewise::constant(value, self.mesh().support())),
            (None, Some(recipe)) => Some(recipe.prepare(&site, &control)?),
            (None, None) => None,
        };
        let sampling = sampling.map(|sampling| sampling.scaled(factor));
        let problem = self.varied_problem(variation);
        let setup = Setup::new(problem, self.mesh().clone(), sampling, control);
        let setup = if self.written[index].entry.skips() { setup.skipping() } else { setup };
        let setup = setup.in_space(constant, self.sampling_of(index), factor)?;
        let controlled = setup.control_transmittance;
        // Without collisions a draw does not begin with the weight T_c.
        if !takes_sampling || (FAINTEST..=1.0 / FAINTEST).contains(&controlled) {
            return Ok(setup);
        }
        if setup.log_unit == 0.0 {
            let needs = "a control with T_c between 1e-300 and 1e300";
            return Err(Refusal::mismatch(needs, format!("T_c = {controlled:e}")));
        }
        let needs = "draws between 1e-300 and 1e300 times T";
        let control = setup.control.optical_depth(setup.mesh.support()).value;
        let [whole, control] = [setup.log_unit, control].map(rounded);
        let found = format!("τ = {whole}, of which the control takes {control}");
        Err(Refusal::mismatch(needs, found))
    }

    fn varied_problem(&self, variation: Variation) -> Arc<P> {
        let varied = match variation {
            Some((What::Albedo, albedo)) => self.problem.with_albedo(albedo),
            _ => None,
        };
        varied.map_or_else(|| self.problem.clone(), Arc::new)
    }

    fn varied_entry(&self, index: usize, variation: Variation) -> Option<Box<dyn Entry<P>>> {
        match variation {
            Some((What::Albedo, albedo)) => self.written[index].entry.with_albedo(albedo),
            _ => None,
        }
    }
}

impl<P: Mutable> AnyScenario for Scenario<P> {
    fn medium(&self) -> &str {
        self.body.name()
    }

    fn distances(&self) -> Vec<f64> {
        self.problem.distances()
    }

    fn estimators(&self) -> usize {
        self.written.len()
    }

    fn draw_by(&mut self, order: Order) {
        for written in &mut self.written {
            written.order = order;
        }
    }

    fn depends_on(&self, estimator: usize, what: What) -> bool {
        let written = &self.written[estimator];
        let inputs = written.entry.inputs();
        match what {
            What::Sampling => inputs.sampling && written.sampling.is_none(),
            What::SamplingScale => inputs.sampling,
            What::Albedo => {
                written.entry.with_albedo(0.5).is_some() || self.problem.with_albedo(0.5).is_some()
            }
            What::Control => inputs.control && written.control.is_none(),
            What::Points => {
                let control = written.control.as_deref().or(self.control.as_deref());
                inputs.control && control.is_some_and(|control| control.with_points(2).is_some())
            }
        }
    }

    fn names(&self, estimator: usize, variation: Variation) -> Names {
        let written = &self.written[estimator];
        let swept_albedo = matches!(variation, Some((What::Albedo, _)));
        let name = written.label(!swept_albedo);
        let control = self.with_control(estimator, variation, |recipe| recipe.label());
        let (sampling, sampling_kind) = match (variation, self.sampling_of(estimator)) {
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
        let alias = if is_plain { written.alias() } else { None };
        Names { estimator: name, sampling, sampling_kind, control, alias }
    }

    fn prepare(&self, estimator: usize, variation: Variation, address: Address) -> Prepared {
        let written = &self.written[estimator];
        let varied = self.varied_entry(estimator, variation);
        let entry = varied.as_deref().unwrap_or(&*written.entry);
        let order = written.order();
        let expect_biased = written.expect_biased;
        let outcome = self.setup(estimator, variation, address).and_then(|setup| {
            if order == Order::Free {
                let needs = "∫σ̂ ≤ 1e6 for order-free draws (the ordered kernel has no such limit)";
                setup.require_few_collisions(needs)?;
            }
            let refusal = entry.domain(&setup).err();
            if let Some(refusal) = refusal {
                if !expect_biased {
                    return Err(refusal);
                }
                // Forced: the formulas do not hold here, only the truth does.
                let prediction = entry.predict(&setup).only_the_truth();
                return Ok(Ready { experiment: entry.experiment(setup, order), prediction });
            }
            let prediction = predict(entry, &setup, order);
            Ok(Ready { experiment: entry.experiment(setup, order), prediction })
        });
        let outcome = outcome.and_then(refuse_what_cannot_be_computed);
        Prepared { outcome, expect_biased }
    }

    fn predict(
        &self,
        estimator: usize,
        variation: Variation,
        what_if: Option<f64>,
        pilots: Address,
    ) -> Option<Prediction> {
        let varied = self.varied_entry(estimator, variation);
        let entry = varied.as_deref().unwrap_or(&*self.written[estimator].entry);
        let setup = self.setup_at(estimator, variation, what_if, pilots).ok()?;
        let setup = Setup { laws: false, ..setup };
        entry.domain(&setup).ok()?;
        Some(predict(entry, &setup, self.written[estimator].order()))
    }

    fn portrait(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
    ) -> Option<(Portrait, Vec<[f64; 2]>)> {
        let setup = self.setup(estimator, variation, address).ok()?;
        let portrait = self.written[estimator].entry.portrait(&setup, address)?;
        let site = Site { body: &self.body, mesh: self.mesh(), address };
        let points = self.with_control(estimator, variation, |recipe| recipe.points(&site));
        Some((portrait, points))
    }

    fn natural_scale(&self, estimator: usize, variation: Variation) -> f64 {
        let Ok(setup) = self.setup(estimator, variation, NOWHERE) else { return 0.0 };
        let control = &setup.control;
        let largest = setup.mesh.largest(|t, sigma| (sigma - control.extinction(t)).abs());
        largest.map_or(0.0, |(_, size)| size)
    }

    fn mutated(
        &self,
        estimator: usize,
        variation: Variation,
        address: Address,
        name: &str,
        walk: Walk,
    ) -> Option<Result<Box<dyn Experiment>, Refusal>> {
        self.mutant(name, walk, |scenario| scenario.setup(estimator, variation, address))
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a checked count
fn whole(points: f64) -> usize {
    points as usize
}

//! Case as written: a problem, its estimators, a sweep and the tolerances of the answer.
//!
//! | key | meaning | default |
//! |---|---|---|
//! | `title` | one line for tables and plots | required |
//! | `draws` | planned draws per experiment; `--draws` overrides it | 4e6; `check`: 4e5 |
//! | `draws_per_ray` | n ≥ 1: draws that share the lookups made for a ray before its first one (explorer points, pilot rays); figures of merit charge each draw 1/n of them | 1 |
//! | `tolerance.mean` | ε of means, relative to the truth (to 1 − T for τ < 0.1), below 1 | the smallest that the draws can show, at most 0.05 |
//! | `tolerance.variance` | ε of variances, relative | the smallest that the draws can show, at most 0.2 |
//! | `tolerance.lookups` | ε of the numbers of lookups, relative | the smallest that the draws can show, at most 0.02 |
//! | `underpowered` | `"allow"`: a mean that cannot pass with so many draws is no reason for exit code 3 | `"refuse"` |
//! | `expect` | `"biased"`: passes only if the bias is shown, and estimators outside their domain are drawn | `"unbiased"` |
//! | `problem.NAME` | the problem, one of the names of `trueflight list problems` | required |
//!
//! With a tolerance an experiment is planned for as many draws as that tolerance and the widest tolerances of the other
//! quantities need, at most `draws`.
//!
//! Within `[problem.NAME]`:
//!
//! | key | meaning |
//! |---|---|
//! | `medium.NAME = { … }` with `span = [from, to]` | a field along a line |
//! | `volume.NAME = { … }` with `ray = { origin, direction, length }` | a field in space, seen along a ray; some problems need less of it, or no ray |
//! | `sampling.NAME = { … }` | σ̂, for every estimator that takes one |
//! | `control.NAME = { … }` | σ_c, for every estimator that takes one |
//! | `sweep.NAME = { … }` | the swept quantity, see `trueflight explain sweep` |
//! | `estimators = [{ NAME = { … } }, …]` | each with its own settings, and its own `sampling`, `control`, `expect`, `kernel` |
//!
//! Short forms: a number for `medium`, `volume`, `sampling` or `control` is the page `constant`, as in `sampling = 2`. A name
//! that needs no settings stands alone or with an empty table, wherever a name is chosen: `control = "mean"`,
//! `phase = "isotropic"`, `estimators = ["ratio", "woodcock"]`. A list of one channel (`medium`, `volume`, `albedos`, `phases`,
//! `sampling`, `forward`) is its one entry, unless an estimator of several channels is listed.

pub(crate) mod build;
pub mod catalogue;
mod channels;
mod course;
pub(crate) mod estimator;
pub(crate) mod forms;
pub mod id;
mod scaling;
pub(crate) mod scenario;
mod shorthand;
pub(crate) mod spec;
pub mod suite;
pub mod sweep;

pub use build::Ready;
pub use catalogue::Catalogue;
pub use course::Course;
pub use scenario::{Scenario, ScenarioAtPoint};
pub use spec::{CaseError, CaseText, Spec};

/// The manual of case files.
pub const CATALOGUE: &[Page] =
    &[Page { module: "case", source: include_str!("mod.rs") }, media::page!(sweep)];

use checks::Tolerance;
use std::path::PathBuf;

use crate::case::estimator::{Defaults, read_expect};
use crate::case::id::ExperimentId;
use crate::case::scenario::ScenarioSource;
use crate::case::sweep::{SweepAxis, SweptQuantity, Variation};
use estimators::Refusal;
use media::Body;
use media::catalogue::own_pages::{self, OwnPages};
use media::catalogue::{Domain, Fault, Mistake, Page, Settings, Value};
use numeric::digits::number;
use numeric::rng::{Address, name_hash};
use theory::problems;

/// Case file that was read.
pub struct Case {
    /// The case's name.
    pub name: String,
    /// Its file; for a built-in case, its name with `.toml`.
    pub path: PathBuf,
    /// One line for tables and plots.
    pub title: String,
    /// The problem's name in the catalogue.
    pub problem: String,
    /// Case file as a tree of settings with places.
    pub spec: Spec,
    /// The problem with its medium and estimators, as written.
    pub scenario: Scenario,
    /// Scenarios at the values of a sweep of the medium.
    varied: Vec<(f64, Scenario)>,
    /// Swept quantity with its values.
    pub sweep: Option<SweepAxis>,
    /// Number of draws of each experiment, if the case gives it.
    pub draws: Option<u64>,
    /// Number of draws that share the setup lookups of a ray.
    pub draws_per_ray: u64,
    /// The relative differences that matter.
    pub tolerance: Tolerance,
    /// True if experiments that are too short to pass are allowed.
    pub allow_underpowered: bool,
    /// A hash of the file's text.
    pub digest: u64,
}

impl Case {
    /// Reads a case of the built-in catalogue; [`crate::case::Catalogue`] also reads cases with pages that a program
    /// adds.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read(source: &CaseText) -> Result<Self, CaseError> {
        Self::read_with(source, &own_pages::NONE)
    }

    /// Reads a case with pages that the program adds.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read_with(source: &CaseText, own_pages: &OwnPages) -> Result<Self, CaseError> {
        Self::of(&Spec::parse(source, own_pages)?)
    }

    /// Reads a case that was parsed.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn of(spec: &Spec) -> Result<Self, CaseError> {
        spec.read(|root| Self::from_root(spec, root, None))
    }

    /// Reads a case that was parsed, with this field in place of its own.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn of_body(spec: &Spec, body: &Body) -> Result<Self, CaseError> {
        spec.read(|root| Self::from_root(spec, root, Some(body)))
    }

    fn from_root(spec: &Spec, root: &Settings, body: Option<&Body>) -> Option<Self> {
        if let (Some(picture), false) = (root.entry("picture"), root.has("problem")) {
            let help = "render it with `trueflight render`; a case has `[problem.NAME]`";
            root.fault_at(
                picture.key_span.clone(),
                "picture",
                "this is a picture, not a case",
                help,
            );
            return None;
        }
        let title = root.text("title");
        let problem = read_problem(root, body);
        let varied = problem.as_ref().and_then(|problem| problem.varied(spec, root));
        let tolerance = read_tolerance(root);
        let draws = if root.has("draws") {
            root.count("draws", 2..=1_000_000_000_000).map(Some)
        } else {
            Some(None)
        };
        let draws_per_ray = root.count_or("draws_per_ray", 1..=1_000_000_000_000, 1);
        let underpowered = root.word_or("underpowered", &["refuse", "allow"], "refuse");
        root.close();
        let source = spec.source();
        let Problem { name: problem, scenario, sweep, .. } = problem?;
        Some(Self {
            name: source.name.clone(),
            path: source.path.clone(),
            title: title?,
            problem,
            spec: spec.clone(),
            scenario,
            varied: varied?,
            sweep,
            draws: draws?,
            draws_per_ray: draws_per_ray?,
            tolerance: tolerance?,
            allow_underpowered: underpowered? == "allow",
            digest: name_hash(&source.text),
        })
    }

    /// Returns the case at a value of its sweep, or as written.
    ///
    /// # Errors
    ///
    /// The value is not in the sweep, and the case cannot be read at it.
    pub fn at(&self, variation: Variation) -> Result<ScenarioAtPoint<'_>, Refusal> {
        let is_swept = |what| self.sweep.as_ref().is_some_and(|axis| axis.what == what);
        let varied = variation.filter(|&(what, _)| what.varies_medium() && is_swept(what));
        let Some((what, value)) = varied else { return Ok(self.as_written(variation)) };
        if let Some((_, known)) = self.varied.iter().find(|(known, _)| *known == value) {
            return Ok(ScenarioAtPoint::new(self, ScenarioSource::Listed(known), variation));
        }
        match read_varied(&self.spec, &self.scenario, what, value) {
            Ok(scenario) => Ok(ScenarioAtPoint::new(
                self,
                ScenarioSource::Beside(Box::new(scenario)),
                variation,
            )),
            Err(faults) => {
                let needs = "a case that can be read at this value of the sweep";
                let actual = faults.first().map_or_else(String::new, |fault| fault.message.clone());
                Err(Refusal::mismatch(needs, actual))
            }
        }
    }

    /// Returns the identity of an experiment.
    pub fn id(&self, estimator: usize, variation: Variation) -> ExperimentId {
        self.at(variation).unwrap_or_else(|_| self.as_written(variation)).id(estimator)
    }

    /// Returns the address of the random numbers of an experiment.
    pub fn address(&self, seed: u64, estimator: usize, variation: Variation) -> Address {
        let at = self.at(variation).unwrap_or_else(|_| self.as_written(variation));
        at.id(estimator).address(seed, at.alias(estimator).as_ref())
    }

    fn as_written(&self, variation: Variation) -> ScenarioAtPoint<'_> {
        ScenarioAtPoint::new(self, ScenarioSource::Listed(&self.scenario), variation)
    }

    /// Returns the address of the random numbers of an estimator's pilot rays. It is the same all along a sweep, so
    /// that the curve in theory and the experiments on it learn the same σ̂.
    pub fn pilots(&self, seed: u64, estimator: usize) -> Address {
        let at = self.as_written(None);
        let id = ExperimentId { namesake: estimator + 1, ..at.unnumbered(estimator) };
        id.address(seed, at.alias(estimator).as_ref())
    }
}

/// Settings `[problem.NAME]` that were read.
struct Problem {
    name: String,
    scenario: Scenario,
    sweep: Option<SweepAxis>,
}

/// Reads `expect` and `problem`, and no other key. A known field takes the place of the case's own.
fn read_problem(root: &Settings, known: Option<&Body>) -> Option<Problem> {
    let expect_biased = read_expect(root);
    let names = problems::names();
    let (index, settings) = root.chosen("problem", &names)?;
    let kind = build::kind(index, &settings)?;
    let body = match known {
        Some(body) => {
            // Marks the keys as read.
            for key in ["medium", "volume", "span", "ray"] {
                settings.entry(key);
            }
            Some(body.clone())
        }
        None => Body::read_for(&settings, kind.ray),
    };
    let body = body.filter(|body| kind.spectral || has_one_channel(&settings, body));
    let sweep = read_sweep(&settings);
    let swept = sweep.as_ref().ok().and_then(Option::as_ref).map(|axis| axis.what);
    let defaults =
        Defaults { expect_biased: expect_biased.unwrap_or_default(), swept, ..Defaults::default() };
    let scenario = Scenario::read(&kind, &settings, body.as_ref(), defaults);
    settings.close();
    let (scenario, sweep) = (scenario?, sweep.ok()?);
    expect_biased?;
    let none_has = |what| !(0..scenario.estimators()).any(|e| scenario.depends_on(e, what));
    if swept.is_some_and(|what| what == SweptQuantity::Albedo && none_has(what)) {
        let help = "those of colours are swept by `albedo-scale`";
        settings.fault("sweep", "no estimator of this case has an albedo", help);
        return None;
    }
    Some(Problem { name: names[index].clone(), scenario, sweep })
}

impl Problem {
    /// Reads the scenarios at the values of a sweep of the medium; `None` after a mistake in one of them.
    fn varied(&self, spec: &Spec, root: &Settings) -> Option<Vec<(f64, Scenario)>> {
        let axis = self.sweep.as_ref().filter(|axis| axis.what.varies_medium());
        let Some(SweepAxis { what, values, .. }) = axis else { return Some(Vec::new()) };
        let mut varied = Vec::with_capacity(values.len());
        for &value in values {
            match read_varied(spec, &self.scenario, *what, value) {
                Ok(scenario) => varied.push((value, scenario)),
                Err(faults) => {
                    for Fault { span, path, message, help } in faults {
                        let own = || spec.problem().and_then(|(_, own)| spec::entry(own, "sweep"));
                        let place = || own().map_or(0..0, |entry| entry.node.span.clone());
                        let span = if span.is_empty() { place() } else { span };
                        let key = what.key();
                        let own = || format!("problem.{}.sweep.{key}", self.name);
                        let path = if path.is_empty() { own() } else { path };
                        let at = format!("at {key} = {}: {message}", number(value));
                        root.fault_at(span, &path, at, help);
                    }
                    return None;
                }
            }
        }
        Some(varied)
    }
}

/// Reads the scenario of a spec at a value of a sweep of the medium; the error lists the mistakes.
fn read_varied(
    spec: &Spec,
    written: &Scenario,
    what: SweptQuantity,
    value: f64,
) -> Result<Scenario, Vec<Fault>> {
    let spec = spec.at(what, value).map_err(|fault| vec![fault])?;
    let (read, faults) = spec.attempt(|root| read_problem(root, None));
    let scenario = read.map(|read| read.scenario).ok_or(faults)?;
    let media = [written.media(), scenario.media()];
    if !scaling::is_proportional(written.medium(), media, what, value) {
        let message = format!(
            "σ_t of `{}` is not proportional to the settings that its page names",
            written.medium()
        );
        let help = "leave the sweep out, or name other settings where the page is added".to_owned();
        return Err(vec![Fault { span: 0..0, path: String::new(), message, help }]);
    }
    Ok(scenario)
}

/// Records a mistake if the medium is spectral and the problem is about one wavelength.
fn has_one_channel(settings: &Settings, body: &Body) -> bool {
    let Body::Spectral { .. } = body else { return true };
    let key = if settings.has("medium") { "medium" } else { "volume" };
    let help = "give it one field, as in { constant = { extinction = 1 } }";
    settings.fault(key, "this problem is about one channel", help);
    false
}

/// Reads `sweep`, if the file has it.
fn read_sweep(settings: &Settings) -> Result<Option<SweepAxis>, Mistake> {
    match settings.entry("sweep") {
        Some(entry) if !matches!(entry.node.value, Value::Table(_)) => {
            let help = "write what is swept and its values, as in `sweep.sampling = [1, 2, 4]`";
            settings.fault("sweep", "`sweep` is no table", help);
            Err(Mistake)
        }
        Some(_) => {
            let axis = settings.table("sweep").and_then(|table| SweepAxis::read(&table));
            axis.map(Some).ok_or(Mistake)
        }
        None => Ok(None),
    }
}

fn read_tolerance(root: &Settings) -> Option<Tolerance> {
    let value = root.entry("tolerance").map(|entry| &entry.node.value);
    if let Some(Value::Number(x)) = value {
        let help = format!("write `tolerance.mean = {0}`, or `variance` or `lookups`", number(*x));
        root.fault("tolerance", format!("`tolerance` is {}", number(*x)), help);
        return None;
    }
    let Some(settings) = root.table_if("tolerance") else { return Some(Tolerance::default()) };
    let read = |key: &'static str| {
        settings.optional(key, |key| {
            let tolerance = settings.number(key, Domain::Positive)?;
            if tolerance >= 1.0 {
                let help = "a tolerance is relative, as in 0.01";
                settings.fault(key, "a tolerance below 1 is expected", help);
                return None;
            }
            Some(tolerance)
        })
    };
    let (mean, variance, lookups) = (read("mean"), read("variance"), read("lookups"));
    settings.close();
    Some(Tolerance { mean: mean.ok()?, variance: variance.ok()?, lookups: lookups.ok()? })
}

//! A case as written: a problem, its estimators, a sweep and what the user asks of the answer.
//!
//! | key | meaning | default |
//! |---|---|---|
//! | `title` | one line for tables and plots | required |
//! | `draws` | planned draws per experiment; `--draws` overrides it | 4e6; `check`: 4e5 |
//! | `draws_per_ray` | n ≥ 1: draws that share the lookups made for a ray before its first one (explorer points, pilot rays); figures of merit charge each draw 1/n of them | 1 |
//! | `tolerance.mean` | ε of means, relative to the truth (to 1 − T for τ < 0.1), below 1 | what the draws see, at most 0.05 |
//! | `tolerance.variance` | ε of variances, relative | what the draws see, at most 0.2 |
//! | `tolerance.lookups` | ε of the numbers of lookups, relative | what the draws see, at most 0.02 |
//! | `underpowered` | `"allow"`: a mean that cannot pass with so many draws is no reason for exit code 3 | `"refuse"` |
//! | `kernel` | how product estimators draw: `"ordered"`, collision after collision along the ray, or `"order-free"`, faster, other draws of the same law; `--kernel` overrides it | `"ordered"` |
//! | `expect` | `"biased"`: passes only if the bias is shown, and estimators outside their domain are drawn | `"unbiased"` |
//! | `problem.NAME` | what is sought, one of the names of `trueflight list problems` | required |
//!
//! With a tolerance an experiment is planned for as many draws as it and the widest tolerances of the
//! others need, at most `draws`.
//!
//! Within `[problem.NAME]`:
//!
//! | key | meaning |
//! |---|---|
//! | `medium.NAME = { … }` with `span = [from, to]` | a field along a line |
//! | `volume.NAME = { … }` with `ray = { origin, direction, length }` | a field in space, seen along a ray; some problems need less of it, or no ray |
//! | `sampling.NAME = { … }` | σ̂, for every estimator that takes one |
//! | `control.NAME = { … }` | σ_c, for every estimator that takes one |
//! | `sweep.NAME = { … }` | what is varied, see `trueflight explain sweep` |
//! | `estimators = [{ NAME = { … } }, …]` | each with its own settings, and its own `sampling`, `control`, `expect`, `kernel` |
//!
//! Short forms: a number for `medium`, `volume`, `sampling` or `control` is the page `constant`, as in `sampling = 2`. A name
//! that needs no settings stands alone or with an empty table, wherever a name is chosen: `control = "mean"`,
//! `phase = "isotropic"`, `estimators = ["ratio", "woodcock"]`.

pub mod catalogue;
mod course;
pub mod estimator;
pub mod example;
pub mod names;
pub mod problem;
pub mod ready;
pub mod rewrite;
pub mod scenario;
mod shorthand;
pub mod source;
pub mod suite;
pub mod sweep;

pub use catalogue::Catalogue;
pub use source::{CaseError, Source};

/// The manual of case files.
pub const CATALOGUE: PageList = PageList {
    name: "case files",
    pages: &[Page { module: "case", source: include_str!("mod.rs") }, media::page!(sweep)],
};

use std::cell::RefCell;
use std::ops::Range;
use std::path::PathBuf;

use crate::case::estimator::{Defaults, read_expect, read_kernel};
use crate::case::scenario::Scenario;
use crate::case::sweep::{SweepAxis, What};
use crate::plan::options::Tolerance;
use crate::plan::{ExperimentId, addresses};
use media::Body;
use media::catalogue::additions::{self, Additions};
use media::catalogue::{Domain, Entry, Fault, Node, Page, PageList, Settings, Value};
use numeric::digits::number;
use numeric::rng::{Address, name_hash};
use theory::problems;

/// A case file, read.
pub struct Case {
    /// The case's name.
    pub name: String,
    /// Its file; for a built-in case, its name with `.toml`.
    pub path: PathBuf,
    /// One line for tables and plots.
    pub title: String,
    /// The problem's name in the catalogue.
    pub problem: String,
    /// The problem with its medium and estimators.
    pub scenario: Scenario,
    /// What is swept.
    pub sweep: Option<SweepAxis>,
    /// How many draws each experiment makes, if the case says.
    pub draws: Option<u64>,
    /// Number of draws that share the setup lookups of a ray.
    pub draws_per_ray: u64,
    /// The relative differences that matter.
    pub tolerance: Tolerance,
    /// Whether experiments that are too short to pass are allowed.
    pub allow_underpowered: bool,
    /// A hash of the file's text.
    pub digest: u64,
}

impl Case {
    /// Reads a case of the built-in catalogue; [`crate::case::Catalogue`] reads those with pages of a program's own.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read(source: &Source) -> Result<Self, CaseError> {
        Self::read_with(source, &additions::NONE)
    }

    /// Reads a case with pages of the program's own.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read_with(source: &Source, additions: &Additions) -> Result<Self, CaseError> {
        let case = source.read_as(additions, |root| Self::from_root(source, root))?;
        Ok(Self { digest: name_hash(&source.text), ..case })
    }

    fn from_root(source: &Source, root: &Settings) -> Option<Self> {
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
        let problem = read_problem(root).and_then(|read| read.swept(root));
        let tolerance = read_tolerance(root);
        let draws = if root.has("draws") {
            root.count("draws", 2..=1_000_000_000_000).map(Some)
        } else {
            Some(None)
        };
        let draws_per_ray = root.count_or("draws_per_ray", 1..=1_000_000_000_000, 1);
        let underpowered = root.word_or("underpowered", &["refuse", "allow"], "refuse");
        root.close();
        let Problem { name: problem, scenario, sweep, .. } = problem?;
        Some(Self {
            name: source.name.clone(),
            path: source.path.clone(),
            title: title?,
            problem,
            scenario,
            sweep,
            draws: draws?,
            draws_per_ray: draws_per_ray?,
            tolerance: tolerance?,
            allow_underpowered: underpowered? == "allow",
            digest: 0,
        })
    }

    /// Where an estimator's pilot rays find their random numbers: the same all along a sweep, so that
    /// the theory's line and the experiments on it learn the same σ̂.
    pub fn pilots(&self, seed: u64, estimator: usize) -> Address {
        let names = self.scenario.names(estimator, None);
        let id = ExperimentId::new([&self.name, &self.problem], &names, None, estimator);
        addresses::own(seed, &id, names.alias.as_ref())
    }
}

/// `[problem.NAME]`, read.
struct Problem {
    name: String,
    scenario: Scenario,
    sweep: Option<SweepAxis>,
    /// Where the sweep is written.
    place: Range<usize>,
}

/// Reads `expect`, `kernel` and `problem`, and not what is beside them.
fn read_problem(root: &Settings) -> Option<Problem> {
    let (expect_biased, order) = (read_expect(root), read_kernel(root));
    let names: Vec<String> = problems::CATALOGUE.pages.iter().map(Page::name).collect();
    let (index, settings) = root.chosen("problem", &names)?;
    let kind = problem::kind(index);
    let body = Body::read_for(&settings, kind.ray);
    let body = body.filter(|body| kind.spectral || has_one_channel(&settings, body));
    let sweep = read_sweep(&settings);
    let defaults = Defaults {
        expect_biased: expect_biased.unwrap_or_default(),
        order: order.unwrap_or_default(),
        sampling: false,
    };
    let swept = sweep.as_ref().and_then(|sweep| sweep.as_ref()).map(|axis| axis.what);
    let scenario = Scenario::read(&kind, &settings, body.as_ref(), defaults, swept);
    settings.close();
    let (scenario, sweep) = (scenario?, sweep?);
    expect_biased.and(order)?;
    let none_has = |what| !(0..scenario.estimators()).any(|e| scenario.depends_on(e, what));
    if swept.is_some_and(|what| what == What::Albedo && none_has(what)) {
        let help = "those of colours are swept by `albedo-scale`";
        settings.fault("sweep", "no estimator of this case has an albedo", help);
        return None;
    }
    let place = settings.entry("sweep").map_or(0..0, |entry| entry.node.span.clone());
    Some(Problem { name: names[index].clone(), scenario, sweep, place })
}

impl Problem {
    /// The same with the scenarios of a sweep of the medium; `None` after a mistake in one of them.
    fn swept(self, root: &Settings) -> Option<Self> {
        let axis = self.sweep.as_ref().and_then(|axis| Some((axis, axis.what.rewrite()?)));
        let Some((axis, rewrite)) = axis else { return Some(self) };
        let (written, folder) = (root.entries().to_vec(), root.folder.to_owned());
        let additions = root.additions().clone();
        let read = move |value: f64| {
            let mut written = written.clone();
            rewrite(problem_table(&mut written), value).map_err(|fault| vec![fault])?;
            let faults = RefCell::default();
            let read = read_problem(&Settings::new(&written, &folder, &faults).with(&additions));
            read.map(|read| read.scenario).ok_or_else(|| faults.into_inner())
        };
        let mut known = Vec::with_capacity(axis.values.len());
        for &value in &axis.values {
            match read(value) {
                Ok(scenario) => known.push((value, scenario)),
                Err(faults) => {
                    for Fault { span, path, message, help } in faults {
                        let span = if span.is_empty() { self.place.clone() } else { span };
                        let own = || format!("problem.{}.sweep.{}", self.name, axis.what.key());
                        let path = if path.is_empty() { own() } else { path };
                        let at = format!("at {} = {}: {message}", axis.what.key(), number(value));
                        root.fault_at(span, &path, at, help);
                    }
                    return None;
                }
            }
        }
        Some(Self { scenario: self.scenario.with_variants(Box::new(read), known), ..self })
    }
}

/// The table `[problem.NAME]` of a case.
fn problem_table(root: &mut [Entry]) -> &mut [Entry] {
    let mut table = root;
    for key in [Some("problem"), None] {
        let entry = table.iter_mut().find(|entry| key.is_none_or(|key| entry.key == key));
        let Some(Entry { node: Node { value: Value::Table(inner), .. }, .. }) = entry else {
            return &mut [];
        };
        table = inner;
    }
    table
}

/// Refuses a spectral medium where a problem is about one wavelength.
fn has_one_channel(settings: &Settings, body: &Body) -> bool {
    let Body::Spectral { .. } = body else { return true };
    let key = if settings.has("medium") { "medium" } else { "volume" };
    let help = "give it one field, as in { constant = { value = 1 } }; `spectral-transmittance` takes a list";
    settings.fault(key, "this problem is about one channel", help);
    false
}

#[allow(clippy::option_option)] // the outer `None` is a recorded mistake
fn read_sweep(settings: &Settings) -> Option<Option<SweepAxis>> {
    match settings.entry("sweep") {
        Some(entry) if !matches!(entry.node.value, Value::Table(_)) => {
            let help = "write what is swept and its values, as in `sweep.sampling = [1, 2, 4]`";
            settings.fault("sweep", "`sweep` is no table", help);
            None
        }
        Some(_) => SweepAxis::read(&settings.table("sweep")?).map(Some),
        None => Some(None),
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
        if settings.has(key) {
            let tolerance = settings.number(key, Domain::Positive)?;
            if tolerance >= 1.0 {
                let help = "a tolerance is relative, as in 0.01";
                settings.fault(key, "a tolerance below 1 is expected", help);
                return None;
            }
            Some(Some(tolerance))
        } else {
            Some(None)
        }
    };
    let (mean, variance, lookups) = (read("mean"), read("variance"), read("lookups"));
    settings.close();
    Some(Tolerance { mean: mean?, variance: variance?, lookups: lookups? })
}

//! Candidates: estimators of a problem with the settings that are tried, and the case that lists all of them.
//!
//! A candidate is an entry of a case's list of estimators. Its σ̂ is free: one constant, or a factor on local majorants.
//! Other settings have a few values each. Candidates that differ in numbers alone are a family, of which the best is
//! advised.

use std::collections::BTreeSet;

use crate::case::{Case, CaseError, Spec, forms};
use media::Body;
use media::catalogue::{Entry, Node, Page, Value};
use numeric::digits::number;

/// Numbers of segments of local majorants along a ray.
const SEGMENTS: [u32; 7] = [1, 2, 4, 8, 16, 32, 64];
/// Numbers of cells along each side of a grid of local majorants.
const CELLS: [u32; 4] = [4, 8, 16, 32];
/// Numbers of explorer points.
const POINTS: [u32; 5] = [2, 4, 8, 16, 32];
/// Numbers of octaves of noise that explorers look up.
const OCTAVES: [u32; 3] = [1, 2, 4];
/// Numbers of pilot rays.
const PILOTS: [u32; 2] = [2, 8];
/// Albedos of the rules that take one.
const ALBEDOS: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];
/// Settings of a problem that advice replaces.
const REPLACED: [&str; 4] = ["estimators", "sampling", "sweep", "rays"];

/// Key of σ̂.
const SAMPLING: &str = "sampling";

/// An estimator with settings that are tried; its σ̂ is free, unless they give it.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Name in the catalogue.
    pub name: String,
    /// Settings of its entry in a case; often empty.
    settings: Vec<Entry>,
    /// True if σ̂ is given in steps along the ray.
    pub is_profile: bool,
}

impl Candidate {
    fn new(name: &str, settings: Vec<Entry>) -> Self {
        Self { name: name.to_owned(), settings, is_profile: false }
    }

    /// Returns the candidate with σ̂ in steps along the ray.
    #[must_use]
    pub fn with_profile(&self, breaks: &[f64], values: &[f64]) -> Self {
        let list = |key: &str, of: &[f64]| Entry::new(key, Value::numbers(of.iter().copied()));
        let steps = Value::Table(vec![list("breaks", breaks), list("values", values)]);
        let mut settings = self.settings.clone();
        settings.push(sampling("piecewise-constant", steps));
        Self { name: self.name.clone(), settings, is_profile: true }
    }

    /// Returns the entry of a list of estimators, as in `single = { rule = "clamped" }`.
    pub fn line(&self) -> String {
        self.written(Numbers::Shown)
    }

    fn written(&self, numbers: Numbers) -> String {
        // σ̂ is written with dots, other settings with braces.
        let setting = |entry: &Entry| {
            let (mut key, mut value) = (entry.key.clone(), &entry.node.value);
            while let (SAMPLING, Value::Table(inner)) = (&*entry.key, value) {
                let [only] = &inner[..] else { break };
                key = format!("{key}.{}", only.key);
                value = &only.node.value;
            }
            format!("{key} = {}", inline(value, numbers))
        };
        format!("{} = {}", self.name, braces(self.settings.iter().map(setting)))
    }

    /// Returns a key that candidates share if they differ in numbers alone.
    pub fn family(&self) -> String {
        let mut key = self.written(Numbers::Omitted);
        key.retain(|c| !matches!(c, '.' | '-' | ' '));
        key
    }

    /// Returns the name of its price: numbers of a profile depend on prices.
    pub fn price_key(&self) -> String {
        if self.is_profile { self.family() } else { self.line() }
    }
}

/// Form of the numbers in a line of TOML.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Numbers {
    Shown,
    Omitted,
}

/// Returns the setting of a recipe for σ̂.
fn sampling(recipe: &str, settings: Value) -> Entry {
    Entry::new(SAMPLING, Value::keyed(recipe, settings))
}

/// Returns the candidates of a case: every estimator of its problem, and those that the case lists, each without its
/// σ̂. Candidates that the case cannot have are left out.
///
/// # Errors
///
/// Mistakes in the case.
pub fn listed(base: &Case, rays: &[Body]) -> Result<Vec<Candidate>, CaseError> {
    let (problem, settings) = base.spec.problem().unwrap_or(("", &[]));
    let form = forms::chosen_form(problem, settings);
    let names = form.iter().flat_map(|form| form.pages.iter().map(Page::name));
    let mut tried: Vec<Candidate> = names.map(|name| Candidate::new(&name, vec![])).collect();
    if form.is_some_and(|form| form.problem == "transmittance" && form.options.is_empty()) {
        tried.extend(of_transmittance(rays.len()));
    }
    tried.extend(own(settings));
    // Without a control it is ratio tracking.
    let without_control = Candidate::new("double", vec![]);
    let mut all: Vec<Candidate> = Vec::new();
    for candidate in tried {
        if candidate != without_control && !all.contains(&candidate) {
            all.push(candidate);
        }
    }
    let Some(first) = rays.first() else { return Ok(Vec::new()) };
    match Case::of_body(&replaced(&base.spec, &all), first) {
        Ok(_) => Ok(all),
        Err(CaseError::Faulty { source_text, faults }) => {
            let places: Vec<Option<usize>> =
                faults.iter().map(|fault| place(&fault.path)).collect();
            if places.contains(&None) {
                return Err(CaseError::Faulty { source_text, faults });
            }
            let wrong: BTreeSet<usize> = places.into_iter().flatten().collect();
            let kept = all.into_iter().enumerate().filter(|(at, _)| !wrong.contains(at));
            Ok(kept.map(|(_, candidate)| candidate).collect())
        }
        Err(other) => Err(other),
    }
}

/// Settings of the estimators of a transmittance that are tried beside the defaults.
fn of_transmittance(rays: usize) -> Vec<Candidate> {
    let number = |x: u32| Value::Number(f64::from(x));
    let rule = |rule: &str| Entry::new("rule", Value::Text(rule.to_owned()));
    let control = |recipe: &str, of| Entry::new("control", Value::keyed(recipe, Value::Table(of)));
    let majorants = |of: Value| sampling("local-majorants", of);
    let mut all = Vec::new();
    // On one ray, the majorant of one segment is a constant.
    let segments = SEGMENTS.into_iter().filter(|&n| n > 1 || rays > 1);
    let segments = segments.map(|n| majorants(Value::keyed("segments", number(n))));
    let cells = CELLS.map(|n| majorants(Value::keyed("grid", Value::numbers([f64::from(n); 3]))));
    for recipe in segments.chain(cells) {
        let names = ["woodcock", "local-majorant", "ratio"];
        all.extend(names.map(|name| Candidate::new(name, vec![recipe.clone()])));
        all.push(Candidate::new("single", vec![rule("terminating"), recipe]));
    }
    all.push(Candidate::new("residual-ratio", vec![control("minimum", vec![])]));
    let single = |settings: Vec<Entry>| Candidate::new("single", settings);
    all.extend(["terminating", "clamped"].map(|word| single(vec![rule(word)])));
    for word in ["non-terminating", "adaptive"] {
        let albedo = |albedo| Entry::new("albedo", Value::Number(albedo));
        all.extend(ALBEDOS.map(|a| single(vec![rule(word), albedo(a)])));
    }
    for rays in PILOTS {
        let recipe = sampling("pilot", Value::keyed("rays", number(rays)));
        let names = ["ratio", "weighted-delta"];
        all.extend(names.map(|name| Candidate::new(name, vec![recipe.clone()])));
        all.push(single(vec![rule("clamped"), recipe]));
    }
    for points in POINTS {
        let points = Entry::new("points", number(points));
        let double = |of: Vec<Entry>| Candidate::new("double", vec![control("explorers", of)]);
        all.push(double(vec![points.clone()]));
        let octaves = |octaves| Entry::new("octaves", number(octaves));
        all.extend(OCTAVES.map(|n| double(vec![points.clone(), octaves(n)])));
    }
    all
}

/// Estimators that the case lists, without σ̂ and without the declaration of a bias.
fn own(settings: &[Entry]) -> Vec<Candidate> {
    let list = settings.iter().find(|entry| entry.key == "estimators");
    let Some(Value::Array(items)) = list.map(|entry| &entry.node.value) else { return Vec::new() };
    let candidate = |item: &Node| match item.value.unplaced() {
        Value::Table(choice) => {
            let Entry { key, node, .. } = choice.into_iter().next()?;
            let Value::Table(mut inner) = node.value else { return None };
            inner.retain(|entry| entry.key != SAMPLING && entry.key != "expect");
            Some(Candidate::new(&key, inner))
        }
        Value::Text(name) => Some(Candidate::new(&name, vec![])),
        _ => None,
    };
    items.iter().filter_map(candidate).collect()
}

/// Returns a value in one line of TOML.
fn inline(value: &Value, numbers: Numbers) -> String {
    match value {
        Value::Table(entries) => {
            let pair =
                |entry: &Entry| format!("{} = {}", entry.key, inline(&entry.node.value, numbers));
            braces(entries.iter().map(pair))
        }
        Value::Array(items) => {
            let items = items.iter().map(|item| inline(&item.value, numbers));
            format!("[{}]", items.collect::<Vec<_>>().join(", "))
        }
        Value::Number(_) if numbers == Numbers::Omitted => String::new(),
        Value::Number(x) => number(*x),
        Value::Text(text) => toml::Value::from(text.as_str()).to_string(),
        Value::Boolean(flag) => flag.to_string(),
        Value::Other(_) => String::new(),
    }
}

/// Returns a table of these settings in one line of TOML.
fn braces(settings: impl Iterator<Item = String>) -> String {
    match settings.collect::<Vec<_>>() {
        none if none.is_empty() => "{}".to_owned(),
        some => format!("{{ {} }}", some.join(", ")),
    }
}

/// Returns the index of the candidate to which the path of a mistake leads.
fn place(path: &str) -> Option<usize> {
    path.split_once("estimators[")?.1.split_once(']')?.0.parse().ok()
}

/// Returns a spec with these estimators in place of its own, and a σ̂ of 1 until one is chosen.
pub fn replaced(spec: &Spec, candidates: &[Candidate]) -> Spec {
    let one = |of: &Candidate| Value::keyed(&of.name, Value::Table(of.settings.clone())).into();
    let list = Value::Array(candidates.iter().map(one).collect());
    spec.with_problem(|settings| {
        settings.retain(|entry| !REPLACED.contains(&&*entry.key));
        settings.push(sampling("constant", Value::keyed("value", Value::Number(1.0))));
        settings.push(Entry::new("estimators", list));
    })
}

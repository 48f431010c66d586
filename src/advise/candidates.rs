//! Candidates: estimators of a problem with the settings that are tried, and the case that lists all of them.
//!
//! A candidate is an entry of a case's list of estimators. Its σ̂ is free: one constant, or a factor on local majorants.
//! Other settings have a few values each. Candidates that differ in numbers alone are a family, of which the best is
//! advised.

use std::cell::RefCell;
use std::collections::BTreeSet;

use crate::case::{Case, CaseError, Source, Spec, forms};
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
/// Recipe of σ̂ by which a case takes a profile.
pub const RECIPE: &str = "sampling.piecewise-constant";
/// Settings of a problem that advice replaces.
const REPLACED: [&str; 4] = ["estimators", "sampling", "sweep", "rays"];

/// An estimator with settings that are tried; its σ̂ is free, unless they give it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Candidate {
    /// Name in the catalogue.
    pub name: String,
    /// Settings in the form of a case; often empty.
    settings: String,
    /// True if σ̂ is given in steps along the ray.
    pub is_profile: bool,
}

impl Candidate {
    fn new(name: &str, settings: impl Into<String>) -> Self {
        Self { name: name.to_owned(), settings: settings.into(), is_profile: false }
    }

    /// Returns the candidate with σ̂ in steps along the ray.
    #[must_use]
    pub fn with_profile(&self, breaks: &[f64], values: &[f64]) -> Self {
        let list =
            |numbers: &[f64]| numbers.iter().map(|&x| number(x)).collect::<Vec<_>>().join(", ");
        let (breaks, values) = (list(breaks), list(values));
        let sampling = format!("{RECIPE} = {{ breaks = [{breaks}], values = [{values}] }}");
        let comma = if self.settings.is_empty() { "" } else { ", " };
        let settings = format!("{}{comma}{sampling}", self.settings);
        Self { name: self.name.clone(), settings, is_profile: true }
    }

    /// Returns the entry of a list of estimators, as in `single = { rule = "clamped" }`.
    pub fn line(&self) -> String {
        match self.settings.as_str() {
            "" => format!("{} = {{}}", self.name),
            settings => format!("{} = {{ {settings} }}", self.name),
        }
    }

    /// Returns what candidates that differ in numbers alone have in common.
    pub fn family(&self) -> String {
        let is_kept = |c: &char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | ' '));
        let words = self.line().replace("].", "]");
        words.chars().filter(is_kept).collect()
    }

    /// Returns the name of its price: numbers of a profile depend on prices.
    pub fn price_key(&self) -> String {
        if self.is_profile { self.family() } else { self.line() }
    }
}

/// Returns the candidates of a case: every estimator of its problem, and those that the case lists, each without its
/// σ̂. Candidates that the case cannot have are left out.
///
/// # Errors
///
/// Mistakes in the case.
pub fn listed(base: &Case, rays: &[Body]) -> Result<Vec<Candidate>, CaseError> {
    let (problem, settings) = base.spec.problem().unwrap_or(("", &[]));
    let title = forms::title(problem, settings);
    let form =
        estimators::catalogues().into_iter().find(|form| Some(&form.title) == title.as_ref());
    let names = form.iter().flat_map(|form| form.pages.iter().map(Page::name));
    let mut all: Vec<Candidate> = names.map(|name| Candidate::new(&name, "")).collect();
    if title.as_deref() == Some("transmittance") {
        all.extend(of_transmittance(rays.len()));
    }
    all.extend(own(settings));
    // Without a control it is ratio tracking.
    let mut seen = BTreeSet::from([Candidate::new("double", "")]);
    all.retain(|candidate| seen.insert(candidate.clone()));
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
    let mut all = Vec::new();
    // On one ray, the majorant of one segment is a constant.
    let segments = SEGMENTS.iter().filter(|&&n| n > 1 || rays > 1);
    let segments = segments.map(|n| format!("sampling.local-majorants.segments = {n}"));
    let cells = CELLS.iter().map(|n| format!("sampling.local-majorants.grid = [{n}, {n}, {n}]"));
    for recipe in segments.chain(cells) {
        let names = ["woodcock", "local-majorant", "ratio"];
        all.extend(names.map(|name| Candidate::new(name, &*recipe)));
        all.push(Candidate::new("single", format!("rule = \"terminating\", {recipe}")));
    }
    all.push(Candidate::new("residual-ratio", "control = { minimum = {} }"));
    let single = |settings: String| Candidate::new("single", settings);
    all.extend(["terminating", "clamped"].map(|rule| single(format!("rule = \"{rule}\""))));
    for rule in ["non-terminating", "adaptive"] {
        let of = |albedo| single(format!("rule = \"{rule}\", albedo = {albedo}"));
        all.extend(ALBEDOS.map(of));
    }
    for rays in PILOTS {
        let recipe = format!("sampling.pilot.rays = {rays}");
        all.extend(["ratio", "weighted-delta"].map(|name| Candidate::new(name, &*recipe)));
        all.push(single(format!("rule = \"clamped\", {recipe}")));
    }
    for points in POINTS {
        let explorers =
            |more: String| format!("control = {{ explorers = {{ points = {points}{more} }} }}");
        all.push(Candidate::new("double", explorers(String::new())));
        let of = |octaves| Candidate::new("double", explorers(format!(", octaves = {octaves}")));
        all.extend(OCTAVES.map(of));
    }
    all
}

/// Estimators that the case lists, without σ̂ and without the declaration of a bias.
fn own(settings: &[Entry]) -> Vec<Candidate> {
    let list = settings.iter().find(|entry| entry.key == "estimators");
    let Some(Value::Array(items)) = list.map(|entry| &entry.node.value) else { return Vec::new() };
    let candidate = |item: &Node| match &item.value {
        Value::Table(choice) => {
            let Entry { key, node, .. } = choice.first()?;
            let Value::Table(inner) = &node.value else { return None };
            let kept = |entry: &&Entry| !matches!(&*entry.key, "sampling" | "expect");
            Some(Candidate::new(key, pairs(inner.iter().filter(kept))))
        }
        Value::Text(name) => Some(Candidate::new(name, "")),
        _ => None,
    };
    items.iter().filter_map(candidate).collect()
}

/// Returns a value in one line of TOML.
fn inline(value: &Value) -> String {
    match value {
        Value::Table(entries) if entries.is_empty() => "{}".to_owned(),
        Value::Table(entries) => format!("{{ {} }}", pairs(entries)),
        Value::Array(items) => {
            let items: Vec<String> = items.iter().map(|item| inline(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Number(x) => number(*x),
        Value::Text(text) => toml::Value::from(text.as_str()).to_string(),
        Value::Boolean(flag) => flag.to_string(),
        Value::Other(_) => String::new(),
    }
}

/// Returns keys and values in one line of TOML.
fn pairs<'a>(entries: impl IntoIterator<Item = &'a Entry>) -> String {
    let pair = |entry: &Entry| format!("{} = {}", entry.key, inline(&entry.node.value));
    entries.into_iter().map(pair).collect::<Vec<_>>().join(", ")
}

/// Returns the index of the candidate to which the path of a mistake leads.
fn place(path: &str) -> Option<usize> {
    path.split_once("estimators[")?.1.split_once(']')?.0.parse().ok()
}

/// Returns a spec with these estimators in place of its own, and a σ̂ of 1 until one is chosen.
pub fn replaced(spec: &Spec, candidates: &[Candidate]) -> Spec {
    let list: Vec<String> =
        candidates.iter().map(|candidate| format!("{{ {} }}", candidate.line())).collect();
    let text = format!("sampling.constant.value = 1\nestimators = [{}]", list.join(", "));
    spec.with_problem(|settings| {
        settings.retain(|entry| !REPLACED.contains(&&*entry.key));
        settings.extend(parsed(spec, &text));
    })
}

/// Returns the settings that a text has, as parts of a spec.
pub fn parsed(spec: &Spec, text: &str) -> Vec<Entry> {
    Source { text: text.to_owned(), ..spec.source().clone() }.parse(&RefCell::default())
}

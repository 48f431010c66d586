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
use theory::collisions::Rule;
use theory::collisions::rules::{Single, Weight};

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
/// Estimators with a weight at every collision.
const WEIGHING: [&str; 3] = ["ratio", "double", "residual-ratio"];
/// Settings of a problem that advice replaces.
const REPLACED: [&str; 4] = ["estimators", "sampling", "sweep", "rays"];

/// Rule at a collision, for the optimal profile of σ̂.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Collisions {
    /// A weight at every collision: ratio tracking and the double particle.
    Weight,
    /// The single particle.
    Single(Single),
}

impl Collisions {
    /// Returns the rule.
    pub fn rule(&self) -> &dyn Rule {
        match self {
            Self::Weight => &Weight,
            Self::Single(rule) => rule,
        }
    }
}

/// Returns the candidates of a case: every estimator of its problem, and those that the case lists, each without its
/// σ̂. Candidates that the case cannot have are left out.
///
/// # Errors
///
/// Mistakes in the case.
pub fn listed(base: &Case, rays: &[Body]) -> Result<Vec<String>, CaseError> {
    let (problem, settings) = base.spec.problem().unwrap_or(("", &[]));
    let title = forms::title(problem, settings);
    let form =
        estimators::catalogues().into_iter().find(|form| Some(&form.title) == title.as_ref());
    let names = form.iter().flat_map(|form| form.list.pages.iter().map(Page::name));
    let mut texts: Vec<String> = names.map(|name| format!("{name} = {{}}")).collect();
    if title.as_deref() == Some("transmittance") {
        texts.extend(of_transmittance(rays.len()));
    }
    texts.extend(own(settings));
    // Without a control it is ratio tracking.
    let mut seen = BTreeSet::from(["double = {}".to_owned()]);
    texts.retain(|text| seen.insert(text.clone()));
    let Some(first) = rays.first() else { return Ok(Vec::new()) };
    match Case::of_body(&replaced(&base.spec, &texts), first) {
        Ok(_) => Ok(texts),
        Err(CaseError::Faulty { source_text, faults }) => {
            let places: Vec<Option<usize>> =
                faults.iter().map(|fault| place(&fault.path)).collect();
            if places.contains(&None) {
                return Err(CaseError::Faulty { source_text, faults });
            }
            let wrong: BTreeSet<usize> = places.into_iter().flatten().collect();
            let kept = texts.into_iter().enumerate().filter(|(at, _)| !wrong.contains(at));
            Ok(kept.map(|(_, text)| text).collect())
        }
        Err(other) => Err(other),
    }
}

/// Settings of the estimators of a transmittance that are tried beside the defaults.
fn of_transmittance(rays: usize) -> Vec<String> {
    let mut texts = Vec::new();
    // On one ray, the majorant of one segment is a constant.
    let segments = SEGMENTS.iter().filter(|&&n| n > 1 || rays > 1);
    let segments = segments.map(|n| format!("sampling.local-majorants.segments = {n}"));
    let cells = CELLS.iter().map(|n| format!("sampling.local-majorants.grid = [{n}, {n}, {n}]"));
    for recipe in segments.chain(cells) {
        for name in ["woodcock", "local-majorant", "ratio"] {
            texts.push(format!("{name} = {{ {recipe} }}"));
        }
        texts.push(format!("single = {{ rule = \"terminating\", {recipe} }}"));
    }
    texts.push("residual-ratio = { control = { minimum = {} } }".to_owned());
    texts
        .extend(["terminating", "clamped"].map(|rule| format!("single = {{ rule = \"{rule}\" }}")));
    for rule in ["non-terminating", "adaptive"] {
        let text = |albedo| format!("single = {{ rule = \"{rule}\", albedo = {albedo} }}");
        texts.extend(ALBEDOS.map(text));
    }
    for rays in PILOTS {
        let recipe = format!("sampling.pilot.rays = {rays}");
        texts.extend(["ratio", "weighted-delta"].map(|name| format!("{name} = {{ {recipe} }}")));
        texts.push(format!("single = {{ rule = \"clamped\", {recipe} }}"));
    }
    for points in POINTS {
        texts.push(format!("double = {{ control = {{ explorers = {{ points = {points} }} }} }}"));
        let text = |k| {
            format!(
                "double = {{ control = {{ explorers = {{ points = {points}, octaves = {k} }} }} }}"
            )
        };
        texts.extend(OCTAVES.map(text));
    }
    texts
}

/// Estimators that the case lists, without σ̂ and without the declaration of a bias.
fn own(settings: &[Entry]) -> Vec<String> {
    let list = settings.iter().find(|entry| entry.key == "estimators");
    let Some(Value::Array(items)) = list.map(|entry| &entry.node.value) else { return Vec::new() };
    let text = |item: &Node| match &item.value {
        Value::Table(choice) => {
            let Entry { key, node, .. } = choice.first()?;
            let Value::Table(inner) = &node.value else { return None };
            let kept = |entry: &&Entry| !matches!(&*entry.key, "sampling" | "expect");
            let kept = inner.iter().filter(kept).cloned().collect();
            Some(format!("{key} = {}", inline(&Value::Table(kept))))
        }
        Value::Text(name) => Some(format!("{name} = {{}}")),
        _ => None,
    };
    items.iter().filter_map(text).collect()
}

/// Returns a value in one line of TOML.
fn inline(value: &Value) -> String {
    match value {
        Value::Table(entries) if entries.is_empty() => "{}".to_owned(),
        Value::Table(entries) => {
            let pair = |entry: &Entry| format!("{} = {}", entry.key, inline(&entry.node.value));
            format!("{{ {} }}", entries.iter().map(pair).collect::<Vec<_>>().join(", "))
        }
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

/// Returns the index of the candidate to which the path of a mistake leads.
fn place(path: &str) -> Option<usize> {
    path.split_once("estimators[")?.1.split_once(']')?.0.parse().ok()
}

/// Returns a spec with these estimators in place of its own, and a σ̂ of 1 until one is chosen.
pub fn replaced(spec: &Spec, texts: &[String]) -> Spec {
    let list: Vec<String> = texts.iter().map(|text| format!("{{ {text} }}")).collect();
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

/// Returns a candidate without its numbers.
pub fn family(text: &str) -> String {
    let is_kept = |c: &char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | ' '));
    let words = text.replace("].", "]");
    words.chars().filter(is_kept).collect()
}

/// Returns whether σ̂ of a candidate is given in steps along the ray.
pub fn is_profile(text: &str) -> bool {
    text.contains(RECIPE)
}

/// Returns whether σ̂ of a candidate is learned by lookups at random places.
pub fn is_learned(text: &str) -> bool {
    text.contains("sampling.pilot")
}

/// Returns whether a candidate has a weight at every collision: its losses `J_k = ∫ ρ^k/σ̂^{k−1}` at one σ̂ give those at
/// all multiples of it.
pub fn weighs(text: &str) -> bool {
    text.split_once(" = ").is_some_and(|(name, _)| WEIGHING.contains(&name))
}

/// Returns the rule of a product estimator with one free constant σ̂; `None` for other candidates.
pub fn rule(text: &str) -> Option<Collisions> {
    let (name, settings) = text.split_once(" = ")?;
    let albedo = || settings.split_once("albedo = ")?.1.split([',', ' ']).next()?.parse().ok();
    let is = |rule: &str| settings.contains(&format!("rule = \"{rule}\""));
    let single = match name {
        _ if settings.contains("sampling.") => return None,
        _ if weighs(text) => return Some(Collisions::Weight),
        "weighted-delta" => Single::NonTerminating { albedo: 1.0 },
        "single" if is("terminating") => Single::Terminating,
        "single" if is("clamped") => Single::Clamped,
        "single" if is("adaptive") => Single::Adaptive { albedo: albedo()? },
        "single" => Single::NonTerminating { albedo: albedo()? },
        _ => return None,
    };
    Some(Collisions::Single(single))
}

//! Case files as a name, a text or a dict.

use std::path::Path;

use pyo3::prelude::*;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::case::Catalogue;
use trueflight::case::Spec;
use trueflight::case::suite;
use trueflight::case::sweep::SweptQuantity;
use trueflight::catalogue::own_pages;

use crate::error::Failure;

/// Cases: the form in which they are given (`named`, `toml` or `json`), the name or the text, and a sweep in place of
/// the case's own, with its values.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub struct CaseRequest {
    kind: String,
    text: String,
    sweep: Option<(String, Vec<f64>)>,
}

/// Returns the names of the built-in cases.
#[pyfunction]
pub fn built_in() -> Vec<String> {
    suite::suite().into_iter().map(|source| source.name).collect()
}

impl CaseRequest {
    /// Reads the cases.
    pub fn read(&self) -> Result<Vec<Case>, Failure> {
        if self.kind == "named" && self.sweep.is_none() {
            return Ok(Catalogue::builtin().named(&self.text)?);
        }
        let spec = self.spec()?;
        let Some((key, values)) = &self.sweep else { return Ok(vec![Case::of(&spec)?]) };
        let case = Case::of(&spec.with_sweep(key, values)?)?;
        if case.sweep.as_ref().is_some_and(|axis| !depends(&case, axis.what)) {
            return Err(idle(&spec, key));
        }
        Ok(vec![case])
    }

    /// Reads a single case.
    pub fn read_one(&self) -> Result<Case, Failure> {
        let mut cases = self.read()?;
        match (cases.pop(), cases.is_empty()) {
            (Some(case), true) => Ok(case),
            (last, _) => {
                let names = cases.iter().chain(&last).map(|case| case.name.as_str());
                let (text, names) = (&self.text, names.collect::<Vec<_>>().join(", "));
                Err(Failure::Wrong(format!("{text} is several cases; choose one of: {names}")))
            }
        }
    }

    /// Parses the case as it is written, without its sweep.
    pub fn spec(&self) -> Result<Spec, Failure> {
        Ok(Spec::parse(&self.source()?, &own_pages::NONE)?)
    }

    fn source(&self) -> Result<CaseText, Failure> {
        let text = match self.kind.as_str() {
            "named" => {
                let built_in = suite::find(&self.text).filter(|_| !Path::new(&self.text).exists());
                let from_file = || CaseText::read(Path::new(&self.text));
                return Ok(built_in.map_or_else(from_file, Ok)?);
            }
            "json" => from_json(&self.text)?,
            _ => self.text.clone(),
        };
        Ok(CaseText { name: "case".into(), path: "case.toml".into(), text })
    }
}

/// Converts a dict to TOML, so that mistakes are shown in place.
fn from_json(text: &str) -> Result<String, Failure> {
    let wrong = |error: &dyn std::fmt::Display| {
        Failure::Wrong(format!(
            "the dict is no case: {error}; give texts, numbers, lists and dicts"
        ))
    };
    let table: toml::Table = serde_json::from_str(text).map_err(|error| wrong(&error))?;
    toml::to_string(&table).map_err(|error| wrong(&error))
}

/// Returns whether any estimator of a case depends on the swept quantity.
fn depends(case: &Case, what: SweptQuantity) -> bool {
    (0..case.scenario.estimators()).any(|estimator| case.scenario.depends_on(estimator, what))
}

/// Returns the error that no estimator depends on the swept quantity, with others that could be swept instead.
fn idle(spec: &Spec, key: &str) -> Failure {
    let could = SweptQuantity::all().filter(|&what| {
        let swept = spec.with_sweep(what.key(), &[1.0]).and_then(|spec| Case::of(&spec));
        swept.is_ok_and(|case| depends(&case, what))
    });
    let python = |key: &str| key.replace('-', "_");
    let could = could.map(|what| python(what.key())).collect::<Vec<_>>().join(", ");
    let key = python(key);
    Failure::Wrong(format!(
        "{key} sweeps nothing here: no estimator of the case takes it, or each has its own; give the values of one of: {could}"
    ))
}

//! Case files as a name, a text or a dict.

use std::path::Path;

use pyo3::prelude::*;
use trueflight::case::Case;
use trueflight::case::Catalogue;
use trueflight::case::Source;
use trueflight::case::suite;
use trueflight::case::sweep::What;

use crate::trouble::Trouble;

/// Which cases: how they are told (`named`, `toml` or `json`), the name or the text, and what is swept in place of
/// the case's own sweep, with its values.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub struct Asked {
    kind: String,
    text: String,
    sweep: Option<(String, Vec<f64>)>,
}

/// Everything that can be swept.
const KEYS: [&str; 8] = [
    "sampling",
    "sampling-scale",
    "albedo",
    "control",
    "points",
    "density",
    "albedo-scale",
    "contrast",
];

/// The names of the built-in cases.
#[pyfunction]
pub fn built_in() -> Vec<String> {
    suite::suite().into_iter().map(|source| source.name).collect()
}

impl Asked {
    /// Reads the cases.
    pub fn read(&self) -> Result<Vec<Case>, Trouble> {
        if self.kind == "named" && self.sweep.is_none() {
            return Ok(Catalogue::builtin().named(&self.text)?);
        }
        let source = self.source()?;
        let source = match &self.sweep {
            None => source,
            Some((what, values)) => swept(source, what, values)?,
        };
        let case = Case::read(&source)?;
        if let (Some((key, _)), Some(axis)) = (&self.sweep, &case.sweep)
            && !depends(&case, axis.what)
        {
            return Err(idle(&source, key));
        }
        Ok(vec![case])
    }

    /// Reads a single case.
    pub fn read_one(&self) -> Result<Case, Trouble> {
        let mut cases = self.read()?;
        match (cases.pop(), cases.is_empty()) {
            (Some(case), true) => Ok(case),
            (last, _) => {
                let names = cases.iter().chain(&last).map(|case| case.name.as_str());
                let (text, names) = (&self.text, names.collect::<Vec<_>>().join(", "));
                Err(Trouble::Wrong(format!("{text} is several cases; choose one of: {names}")))
            }
        }
    }

    fn source(&self) -> Result<Source, Trouble> {
        let text = match self.kind.as_str() {
            "named" => {
                let built_in = suite::find(&self.text).filter(|_| !Path::new(&self.text).exists());
                let from_file = || Source::read(Path::new(&self.text));
                return Ok(built_in.map_or_else(from_file, Ok)?);
            }
            "json" => from_json(&self.text)?,
            _ => self.text.clone(),
        };
        Ok(Source { name: "case".into(), path: "case.toml".into(), text })
    }
}

/// A dict as TOML, so that mistakes are shown in place.
fn from_json(text: &str) -> Result<String, Trouble> {
    let wrong = |error: &dyn std::fmt::Display| {
        Trouble::Wrong(format!(
            "the dict is no case: {error}; give texts, numbers, lists and dicts"
        ))
    };
    let table: toml::Table = serde_json::from_str(text).map_err(|error| wrong(&error))?;
    toml::to_string(&table).map_err(|error| wrong(&error))
}

/// The case with another sweep. What is wrong with the case as it is, its reader says.
fn swept(source: Source, what: &str, values: &[f64]) -> Result<Source, Trouble> {
    let Ok(mut table) = source.text.parse::<toml::Table>() else { return Ok(source) };
    let problem = table.get_mut("problem").and_then(toml::Value::as_table_mut);
    let problem = problem.and_then(|problems| problems.iter_mut().next()?.1.as_table_mut());
    let Some(problem) = problem else { return Ok(source) };
    let values = values.iter().copied().map(toml::Value::Float).collect();
    let range = toml::Table::from_iter([("values".to_owned(), toml::Value::Array(values))]);
    let sweep = toml::Table::from_iter([(what.to_owned(), toml::Value::Table(range))]);
    problem.insert("sweep".into(), toml::Value::Table(sweep));
    let text = toml::to_string(&table).map_err(|error| Trouble::Wrong(error.to_string()))?;
    Ok(Source { text, ..source })
}

/// Whether any estimator of a case depends on what is swept.
fn depends(case: &Case, what: What) -> bool {
    (0..case.scenario.estimators()).any(|estimator| case.scenario.depends_on(estimator, what))
}

/// That no estimator depends on what is swept, and what could be swept instead.
fn idle(source: &Source, key: &str) -> Trouble {
    let could = KEYS.iter().filter(|other| {
        let read = swept(source.clone(), other, &[1.0]).ok().and_then(|it| Case::read(&it).ok());
        let axis = read.as_ref().and_then(|case| Some((case, case.sweep.as_ref()?.what)));
        axis.is_some_and(|(case, what)| depends(case, what))
    });
    let python = |key: &str| key.replace('-', "_");
    let could = could.map(|key| python(key)).collect::<Vec<_>>().join(", ");
    let key = python(key);
    Trouble::Wrong(format!(
        "{key} sweeps nothing here: no estimator of the case takes it, or each has its own; give the values of one of: {could}"
    ))
}

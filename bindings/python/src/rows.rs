//! Predictions and runs, as columns in JSON: those of `summary.csv`.

use std::time::Instant;

use pyo3::prelude::*;
use trueflight::case::Case;
use trueflight::draw::run as drawing;
use trueflight::plan::Amount;
use trueflight::plan::Filter;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::plan::options::DRAWS;
use trueflight::record::Record;
use trueflight::record::build;
use trueflight::report::run::summary_csv;

use crate::background::{Progress, work};
use crate::cases::CaseRequest;
use crate::error::Failure;

/// Options of a plan and of its drawing.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
struct RunRequest {
    draws: Option<u64>,
    seed: u64,
    alpha: f64,
    filter: Option<String>,
    threads: usize,
}

impl RunRequest {
    fn options(&self) -> Result<Options, Failure> {
        let wrong = |error| {
            let cure = "a filter is a pattern such as \"*eq21*:single\"";
            Failure::Wrong(format!("{error}; {cure}"))
        };
        let filter = self.filter.as_deref().map(Filter::new).transpose().map_err(wrong)?;
        let draws = self.draws.map_or(Amount::CaseOr(DRAWS), Amount::Exactly);
        Ok(Options { draws, seed: self.seed, alpha: self.alpha, filter, ..Options::default() })
    }

    fn plan<'a>(&self, cases: &'a [Case]) -> Result<Plan<'a>, Failure> {
        let plan = Plan::new(cases, &self.options()?);
        if plan.cases.is_empty() {
            let filter = self.filter.as_deref().unwrap_or_default();
            let text = format!(
                "filter=\"{filter}\" keeps none of the experiments; predict(case) lists what there is"
            );
            return Err(Failure::Wrong(text));
        }
        Ok(plan)
    }
}

/// Predicts every experiment; `optimum` adds the best constant σ̂.
///
/// # Errors
///
/// An invalid case, or a filter that keeps nothing.
#[pyfunction]
pub fn predict(
    py: Python<'_>,
    cases: CaseRequest,
    wanted: &Bound<'_, PyAny>,
    optimum: bool,
) -> PyResult<String> {
    let wanted: RunRequest = wanted.extract()?;
    let predicted = if optimum { build::predicted_with_optima } else { build::predicted };
    work(py, wanted.threads, None, move |_| {
        let cases = cases.read()?;
        columns(&predicted(&wanted.plan(&cases)?))
    })
}

/// Draws every experiment and judges it.
///
/// # Errors
///
/// An invalid case, a filter that keeps nothing, `KeyboardInterrupt`, or an exception of `tell`.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    cases: CaseRequest,
    wanted: &Bound<'_, PyAny>,
    tell: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let wanted: RunRequest = wanted.extract()?;
    work(py, wanted.threads, tell, move |progress| {
        let cases = cases.read()?;
        let plan = wanted.plan(&cases)?;
        columns(&drawn(&plan, progress))
    })
}

fn drawn(plan: &Plan, progress: &Progress) -> Record {
    let ready = plan.experiments().filter(|(_, planned)| planned.outcome.is_ok());
    progress.expect(ready.map(|(_, planned)| planned.draws).sum());
    let begin = Instant::now();
    let draws = drawing::draw(plan, &|step| {
        if let drawing::Step::Drawn(draws) = step {
            progress.add(draws);
        }
    });
    build::judged(plan, &draws, begin.elapsed().as_secs_f64())
}

fn columns(record: &Record) -> Result<String, Failure> {
    summary_csv::columns(record).map_err(|error| Failure::Wrong(error.to_string()))
}

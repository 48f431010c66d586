//! Advice, as columns in JSON: those of `advise.csv`.

use pyo3::prelude::*;
use trueflight::advise::{AdviceRequest, Costs, advise as advised, options};
use trueflight::report::advise::columns;

use crate::background::work;
use crate::cases::CaseRequest;
use crate::error::Failure;

/// Options of an advice; goals and costs are texts as on the command line.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
struct Sought {
    error: String,
    budget: Option<String>,
    cost: Option<String>,
    calibrate: bool,
    majorant: String,
    rays: Option<u64>,
    seed: u64,
    threads: usize,
}

impl Sought {
    fn request(&self) -> Result<AdviceRequest, Failure> {
        let Self { calibrate, rays, seed, .. } = *self;
        let named = |name: &'static str| move |takes| Failure::Wrong(format!("{name}: {takes}"));
        let error = options::error(&self.error).map_err(named("error"))?;
        let budget = self.budget.as_deref().map(options::budget).transpose();
        let costs = self.cost.as_deref().map(options::costs).transpose().map_err(named("cost"))?;
        let costs = costs.unwrap_or_else(|| Costs::of_this_machine(calibrate));
        let (target, costs) = options::goal(error, budget.map_err(named("budget"))?, costs);
        let looseness = options::looseness(&self.majorant).map_err(named("majorant"))?;
        Ok(AdviceRequest { target, costs, rays, seed, looseness, curves: false })
    }
}

/// Advises on a case.
///
/// # Errors
///
/// An invalid case or option.
#[pyfunction]
pub fn advise(py: Python<'_>, case: CaseRequest, sought: &Bound<'_, PyAny>) -> PyResult<String> {
    let sought: Sought = sought.extract()?;
    work(py, sought.threads, None, move |_| {
        let result = advised(&case.spec()?, &sought.request()?)?;
        columns(&result).map_err(|error| Failure::Wrong(error.to_string()))
    })
}

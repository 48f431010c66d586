//! Draws that Python makes, array by array, and the verdict on them.

use std::collections::BTreeMap;

use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use trueflight::OfCase;
use trueflight::check::{Check, CheckError, Property, Pushed};
use trueflight::judge::{BUFFER, ExperimentChoice};

use crate::background::work;
use crate::cases;
use crate::error::Failure;

/// Number of draws that are read at a time: they fit the cache, and other threads of Python run meanwhile.
const PIECE: usize = 8 * BUFFER;

/// Claim as `trueflight.check` passes it.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
pub struct ClaimRequest {
    name: String,
    /// Numbers of each property that is set.
    properties: BTreeMap<String, Vec<f64>>,
    seed: u64,
    case: Option<cases::CaseRequest>,
    estimator: String,
    sampling: Option<f64>,
    nearest: bool,
}

impl ClaimRequest {
    /// Returns the check by numbers.
    fn check(&self) -> Result<Check<()>, Failure> {
        let mut check = trueflight::claim(&self.name).seed(self.seed);
        for (name, numbers) in &self.properties {
            let property = Property::named(name);
            let property = property
                .ok_or_else(|| Failure::Wrong(format!("a check has no property `{name}`")))?;
            check = check.set(property, numbers)?;
        }
        Ok(check)
    }

    /// Adds theory to a check.
    fn with_theory(
        &self,
        check: Check<()>,
        case: &cases::CaseRequest,
    ) -> Result<Check<()>, Failure> {
        let case = case.read_one()?;
        let (estimator, swept, nearest) = (self.estimator.as_str(), self.sampling, self.nearest);
        let choice = ExperimentChoice { estimator, swept, nearest, seed: self.seed, channel: None };
        Ok(check.of_case(&case, &choice))
    }

    /// Validates the claim, and returns the check that takes draws.
    fn open(self, py: Python<'_>) -> PyResult<Pushed> {
        let check = self.check()?;
        let check = match self.case.clone() {
            None => check,
            Some(case) => work(py, 0, None, move |_| self.with_theory(check, &case))?,
        };
        Ok(check.open().map_err(Failure::from)?)
    }
}

/// Contiguous array of Python.
enum Numbers {
    Double(PyBuffer<f64>),
    Single(PyBuffer<f32>),
}

impl Numbers {
    fn new(array: &Bound<'_, PyAny>) -> PyResult<Self> {
        let double = PyBuffer::get(array).map(Self::Double);
        let numbers = double.or_else(|_| PyBuffer::get(array).map(Self::Single))?;
        let is_dense = match &numbers {
            Self::Double(buffer) => buffer.is_c_contiguous(),
            Self::Single(buffer) => buffer.is_c_contiguous(),
        };
        is_dense.then_some(numbers).ok_or_else(|| PyTypeError::new_err("not contiguous"))
    }

    fn len(&self) -> usize {
        match self {
            Self::Double(buffer) => buffer.item_count(),
            Self::Single(buffer) => buffer.item_count(),
        }
    }

    /// Reads `to.len()` numbers from number `from` on.
    fn read(&self, py: Python<'_>, from: usize, to: &mut [f64]) {
        let range = from..from + to.len();
        match self {
            Self::Double(buffer) => {
                let cells = buffer.as_slice(py).and_then(|cells| cells.get(range));
                to.iter_mut().zip(cells.unwrap_or_default()).for_each(|(x, cell)| *x = cell.get());
            }
            Self::Single(buffer) => {
                let cells = buffer.as_slice(py).and_then(|cells| cells.get(range));
                let both = to.iter_mut().zip(cells.unwrap_or_default());
                both.for_each(|(x, cell)| *x = f64::from(cell.get()));
            }
        }
    }
}

/// Adds draws: a contiguous array of float64 or float32, and float64 lookups, if draws have them.
fn absorb(
    py: Python<'_>,
    pushed: &mut Pushed,
    draws: &Numbers,
    lookups: Option<&Numbers>,
) -> PyResult<()> {
    let values = pushed.values();
    let (mut numbers, mut counts) = (Vec::new(), Vec::new());
    for first in (0..draws.len()).step_by(PIECE * values) {
        let count = (draws.len() - first).min(PIECE * values);
        numbers.resize(count, 0.0);
        draws.read(py, first, &mut numbers);
        if let Some(lookups) = lookups {
            counts.resize(count / values, 0.0);
            lookups.read(py, first / values, &mut counts);
        }
        let absorbed: Result<(), CheckError> = py.detach(|| match lookups {
            Some(_) => pushed.absorb_with_lookups(&numbers, &counts),
            None => pushed.absorb(&numbers),
        });
        absorbed.map_err(Failure::from)?;
        py.check_signals()?;
    }
    Ok(())
}

/// Judges the arrays of an iterator, each with its lookups or `None`, until the verdict is decided or there are enough.
///
/// Returns `pass`, `fail` or `inconclusive`, the reason, all lines, and all numbers as JSON.
///
/// # Errors
///
/// An invalid claim, draws that do not match it, `KeyboardInterrupt`, or an exception of the iterator.
#[pyfunction]
pub fn judge(
    py: Python<'_>,
    asked: ClaimRequest,
    arrays: &Bound<'_, PyAny>,
) -> PyResult<(&'static str, String, String, String)> {
    let (mut pushed, mut arrays) = (asked.open(py)?, arrays.try_iter()?);
    pushed.drive(|pushed, _| {
        let Some(array) = arrays.next() else { return Ok(false) };
        let (draws, lookups): (Bound<'_, PyAny>, Option<Bound<'_, PyAny>>) = array?.extract()?;
        let lookups = lookups.as_ref().map(Numbers::new).transpose()?;
        absorb(py, pushed, &Numbers::new(&draws)?, lookups.as_ref())?;
        Ok::<_, PyErr>(true)
    })?;
    let outcome = pushed.verdict().map_err(Failure::from)?;
    let numbers = serde_json::to_string(&outcome);
    let numbers = numbers.map_err(|error| Failure::Wrong(error.to_string()))?;
    Ok((outcome.verdict().word(), outcome.reason(), outcome.to_string(), numbers))
}

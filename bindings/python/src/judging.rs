//! Draws that are pushed, array by array, and the verdict on them.

use pyo3::buffer::PyBuffer;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use trueflight::OfCase;
use trueflight::check::{Check, CheckError, Outcome, Pushed};
use trueflight::judge::{BUFFER, Choice, ROUNDING};

use crate::background::work;
use crate::cases;
use crate::trouble::Trouble;

/// So many numbers are read at a time: few enough for the cache, enough for other threads of Python to run meanwhile.
const PIECE: usize = 8 * BUFFER;

/// What is asked of draws, as the arguments of `trueflight.check` have it.
#[derive(Debug, Clone, FromPyObject)]
#[pyo3(from_item_all)]
struct Asked {
    name: String,
    /// How many values a draw has.
    values: usize,
    /// Whether it tells its lookups.
    counts: bool,
    truth: Option<Vec<f64>>,
    variance: Option<Vec<f64>>,
    kurtosis: Option<Vec<f64>>,
    range: Option<(f64, f64)>,
    lookups: Option<(f64, f64)>,
    rounding: Option<f64>,
    case: Option<cases::Asked>,
    estimator: String,
    sampling: Option<f64>,
    nearest: bool,
    mean_only: bool,
    tolerance: Option<f64>,
    variance_tolerance: Option<f64>,
    batch: u64,
    alpha: f64,
    draws: Option<u64>,
    seed: u64,
}

impl Asked {
    /// The check with everything that numbers say.
    fn check(&self) -> Check<()> {
        let mut check = trueflight::claim(&self.name).batch(self.batch).alpha(self.alpha);
        check = check.seed(self.seed).rounding(self.rounding.unwrap_or(ROUNDING));
        check = check.values(self.values);
        if let Some(truth) = &self.truth {
            // The number of truths tells how many values a draw has.
            let all = if truth.len() == 1 { vec![truth[0]; self.values] } else { truth.clone() };
            check = check.truth(all);
        }
        if let Some(variance) = &self.variance {
            check = check.variance(variance.clone());
        }
        if let Some(kurtosis) = &self.kurtosis {
            check = check.kurtosis(kurtosis.clone());
        }
        if let Some((low, high)) = self.range {
            check = check.range(low, high);
        }
        if let Some((mean, variance)) = self.lookups {
            check = check.lookups(mean, variance);
        }
        if let Some(tolerance) = self.tolerance {
            check = check.tolerance(tolerance);
        }
        if let Some(tolerance) = self.variance_tolerance {
            check = check.variance_tolerance(tolerance);
        }
        if let Some(draws) = self.draws {
            check = check.draws(draws);
        }
        if self.mean_only { check.mean_only() } else { check }
    }

    /// The same with what theory says.
    fn with_theory(&self, case: &cases::Asked) -> Result<Check<()>, Trouble> {
        let case = case.read_one()?;
        let (estimator, swept, nearest) = (self.estimator.as_str(), self.sampling, self.nearest);
        let choice = Choice { estimator, swept, nearest, seed: self.seed, channel: None };
        Ok(self.check().of_case(&case, &choice))
    }

    /// Whether there is a number for each value of a draw.
    fn is_wide(&self, what: &'static str, found: usize) -> Result<(), Trouble> {
        let (name, wanted) = (self.name.clone(), self.values);
        if found == wanted {
            return Ok(());
        }
        Err(CheckError::Values { name, what, found, wanted }.into())
    }

    /// What does not go with the draws.
    fn fits(&self) -> Result<(), Trouble> {
        let truths = self.truth.as_ref().map_or(1, Vec::len);
        if truths != 1 {
            self.is_wide("truth", truths)?;
        }
        if self.lookups.is_some() && !self.counts {
            return Err(CheckError::NoLookups { name: self.name.clone() }.into());
        }
        if self.truth.is_none() && self.case.is_none() {
            return Err(CheckError::NoTruth { name: self.name.clone() }.into());
        }
        Ok(())
    }
}

/// Numbers of Python's that lie side by side.
enum Numbers {
    Double(PyBuffer<f64>),
    Single(PyBuffer<f32>),
}

impl Numbers {
    fn of(array: &Bound<'_, PyAny>) -> PyResult<Self> {
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

/// A check that waits for draws.
#[pyclass(module = "trueflight._trueflight")]
pub struct Judging {
    /// `None` once there is a verdict.
    pushed: Option<Pushed>,
    values: usize,
    counts: bool,
}

#[pymethods]
impl Judging {
    #[new]
    fn new(py: Python<'_>, asked: &Bound<'_, PyAny>) -> PyResult<Self> {
        let asked: Asked = asked.extract()?;
        asked.fits()?;
        let (values, counts) = (asked.values, asked.counts);
        let check = match asked.case.clone() {
            None => asked.check(),
            Some(case) => work(py, 0, None, move |_| asked.with_theory(&case))?,
        };
        let pushed = check.open().map_err(Trouble::from)?;
        Ok(Self { pushed: Some(pushed), values, counts })
    }

    /// Adds draws: an array of float64 or float32, contiguous, and as many lookups of float64, if draws tell them.
    fn absorb(
        &mut self,
        py: Python<'_>,
        draws: &Bound<'_, PyAny>,
        lookups: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let draws = Numbers::of(draws)?;
        let lookups = lookups.map(Numbers::of).transpose()?;
        let (values, counts) = (self.values, self.counts);
        let pushed = self.opened()?;
        let (mut numbers, mut tolds) = (Vec::new(), Vec::new());
        for first in (0..draws.len()).step_by(PIECE * values) {
            let count = (draws.len() - first).min(PIECE * values);
            numbers.resize(count, 0.0);
            draws.read(py, first, &mut numbers);
            if let Some(lookups) = &lookups {
                tolds.resize(count / values, 0.0);
                lookups.read(py, first / values, &mut tolds);
            }
            let absorbed = py.detach(|| {
                if counts {
                    pushed.absorb_with_lookups(&numbers, &tolds)
                } else {
                    pushed.absorb(&numbers)
                }
            });
            absorbed.map_err(Trouble::from)?;
            py.check_signals()?;
        }
        Ok(())
    }

    /// Whether more draws may change what is said.
    fn is_open(&mut self) -> PyResult<bool> {
        Ok(self.opened()?.is_open())
    }

    /// What is said of all draws: `pass`, `fail` or `inconclusive`, why, all lines, and all numbers as JSON.
    fn verdict(&mut self) -> PyResult<(&'static str, String, String, String)> {
        let pushed = self.pushed.take();
        let outcome = pushed.map(Pushed::verdict).transpose().map_err(Trouble::from)?;
        let outcome: Outcome = outcome.ok_or_else(closed)?;
        let numbers = serde_json::to_string(&outcome);
        let numbers = numbers.map_err(|error| Trouble::Wrong(error.to_string()))?;
        Ok((outcome.verdict().word(), outcome.reason(), outcome.to_string(), numbers))
    }
}

impl Judging {
    fn opened(&mut self) -> PyResult<&mut Pushed> {
        self.pushed.as_mut().ok_or_else(|| closed().into())
    }
}

fn closed() -> Trouble {
    Trouble::Wrong("this check has its verdict; begin another".into())
}

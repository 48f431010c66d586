//! Whether what a setter is given makes sense by itself. What does not go together is told before the first draw.

use trueflight::check::MAX_VALUES;
use trueflight::judge::claim::{Claim, Given};
use trueflight::judge::trial::{Trial, Wanted};

/// Looks at what is claimed of a draw.
pub(crate) fn given(given: Given) -> Result<(), String> {
    Claim::new(&given).map(drop).map_err(|error| error.to_string())
}

/// Looks at a list of numbers, one by one.
pub(crate) fn all(numbers: &[f64], claim: impl Fn(f64) -> Given) -> Result<(), String> {
    if numbers.is_empty() {
        return Err("a list is empty; give one number for each value of a draw".to_owned());
    }
    numbers.iter().try_for_each(|&number| given(claim(number)))
}

/// Looks at a range.
pub(crate) fn range(low: f64, high: f64) -> Result<(), String> {
    if low < high {
        return Ok(());
    }
    Err(format!("a range of {low} to {high} has nothing inside; give a lower and a higher end"))
}

/// Looks at a number of values of a draw.
pub(crate) fn values(values: usize) -> Result<(), String> {
    if (1..=MAX_VALUES).contains(&values) {
        return Ok(());
    }
    Err(format!("a draw has {values} values; give a number from 1 to {MAX_VALUES}"))
}

/// Looks at what is wanted of the verdict, as if the draws had mean and variance 1.
pub(crate) fn wanted(wanted: Wanted) -> Result<(), String> {
    let claim = Given { truth: 1.0, variance: Some(1.0), ..Given::default() };
    let trial = Claim::new(&claim).and_then(|claim| Trial::new(claim, wanted, None));
    trial.map(drop).map_err(|error| error.to_string())
}

//! Goals and costs as text, for the command line and for Python.

use std::ops::RangeInclusive;

use super::{Costs, Target};

/// Units of time, in seconds.
const UNITS: [(&str, f64); 7] = [
    ("ns", 1e-9),
    ("us", 1e-6),
    ("µs", 1e-6),
    ("ms", 1e-3),
    ("s", 1.0),
    ("m", 60.0),
    ("h", 3600.0),
];

/// Times that are taken, other than 0, in seconds.
pub const TIMES: RangeInclusive<f64> = 1e-15..=1e12;
/// Numbers of lookups that are taken as a budget.
const LOOKUPS: RangeInclusive<f64> = 1.0..=1e18;
/// Relative errors that are taken.
const ERRORS: RangeInclusive<f64> = 1e-9..=0.999;
/// Factors of majorants that are taken.
const LOOSENESS: RangeInclusive<f64> = 1.0..=1e6;

/// Budget of each ray, as an option gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// Seconds.
    Seconds(f64),
    /// Lookups.
    Lookups(f64),
}

/// Returns the goal and the costs that options ask for; a budget of lookups counts nothing else.
pub fn goal(error: f64, budget: Option<Budget>, costs: Costs) -> (Target, Costs) {
    match budget {
        None => (Target::Error(error), costs),
        Some(Budget::Seconds(seconds)) => (Target::Budget(seconds), costs),
        Some(Budget::Lookups(lookups)) => (Target::Budget(lookups), Costs::Lookups),
    }
}

/// Parses a relative error, as a number or in percent.
///
/// # Errors
///
/// The errors that it takes.
pub fn error(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let number = number.trim().parse::<f64>().ok().map(|x| x * unit);
    let number = number.filter(|error| ERRORS.contains(error));
    number.ok_or_else(|| "it takes an error from 1e-9 to 0.999, such as 1% or 0.01".to_owned())
}

/// Parses the factor by which majorants exceed the maximum.
///
/// # Errors
///
/// The factors that it takes.
pub fn looseness(text: &str) -> Result<f64, String> {
    let factor = text.parse::<f64>().ok().filter(|factor| LOOSENESS.contains(factor));
    factor.ok_or_else(|| "it takes a factor from 1 to 1e6, such as 2".to_owned())
}

/// Parses a time with its unit.
fn seconds(text: &str) -> Option<f64> {
    let unit = |(word, unit): &(&str, f64)| Some((text.strip_suffix(word)?.trim(), *unit));
    let (number, unit) = UNITS.iter().find_map(unit)?;
    number.parse::<f64>().ok().map(|x| x * unit).filter(|x| *x == 0.0 || TIMES.contains(x))
}

/// Parses a time, or a number of lookups.
///
/// # Errors
///
/// The budgets that it takes.
pub fn budget(text: &str) -> Result<Budget, String> {
    let lookups = text.parse::<f64>().ok().filter(|n| LOOKUPS.contains(n));
    let time = seconds(text).filter(|&time| time > 0.0).map(Budget::Seconds);
    let takes = "it takes a time from 1e-15s to 1e12s, such as 30s or 5ms, or a number of lookups from 1 to 1e18";
    time.or(lookups.map(Budget::Lookups)).ok_or_else(|| takes.to_owned())
}

/// Parses costs of draws and lookups.
///
/// # Errors
///
/// The costs that it takes.
pub fn costs(text: &str) -> Result<Costs, String> {
    let takes = "it takes times such as lookup=2us or draw=50ns,lookup=2us, from 1e-15s to 1e12s";
    let (mut draw, mut lookup) = (None, None);
    for part in text.split(',') {
        let known = match part.split_once('=').map(|(key, time)| (key.trim(), seconds(time))) {
            Some(("draw", Some(time))) => draw.replace(time),
            Some(("lookup", Some(time))) => lookup.replace(time),
            _ => return Err(takes.to_owned()),
        };
        if known.is_some() {
            return Err(format!("it takes each cost once, and {} is another one", part.trim()));
        }
    }
    let draw = draw.unwrap_or(0.0);
    let lookup = lookup.filter(|lookup| draw + lookup > 0.0);
    lookup.map(|lookup| Costs::Given { draw, lookup }).ok_or_else(|| takes.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_are_read_with_their_units() {
        assert_eq!((error("1%"), error("0.5 %"), error("1e-3")), (Ok(0.01), Ok(0.005), Ok(1e-3)));
        assert!(error("1").is_err() && error("0%").is_err() && error("few").is_err());
        for wrong in ["0", "-1", "nan", "1e308", "1e-320", "inf", ""] {
            assert!(error(wrong).is_err() && budget(wrong).is_err(), "{wrong}");
            assert!(looseness(wrong).is_err(), "{wrong}");
            assert!(costs(&format!("lookup={wrong}s")).is_err(), "{wrong}");
        }
        assert_eq!(budget("5ms"), Ok(Budget::Seconds(5e-3)));
        assert_eq!(budget("1e6"), Ok(Budget::Lookups(1e6)));
        assert!(budget("0s").is_err() && budget("0.1").is_err() && budget("5 days").is_err());
        let given = |draw, lookup| Ok(Costs::Given { draw, lookup });
        assert_eq!(costs("lookup=2us"), given(0.0, 2e-6));
        assert_eq!(costs("draw=5ms, lookup=1s"), given(5e-3, 1.0));
        for wrong in ["2us", "lookup=2", "draw=1s", "lookup=0s", "step=1s,lookup=1s", ""] {
            assert!(costs(wrong).is_err_and(|said| said.contains("lookup=2us")), "{wrong}");
        }
        let twice = costs("lookup=1us,lookup=2us").expect_err("one cost twice");
        assert_eq!(twice, "it takes each cost once, and lookup=2us is another one");
    }
}

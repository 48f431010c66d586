//! The verdict of a check, or the reason why it has no verdict.

use std::error::Error;
use std::fmt;

use crate::session::{ClaimError, Judgement};
use crate::stats::verdict::Verdict;
use numeric::digits::number;

/// Maximum number of values of a draw that are judged together: with more, the share of α of each is too small.
pub const MAX_VALUES: usize = 1 << 16;

/// Maximum number of values that are displayed.
const TOLD: usize = 8;

/// The verdict of a check, with all numbers that `trueflight judge` prints.
///
/// ```
/// let outcome = trueflight_gate::check("u", |rng| rng.uniform()).truth(0.6).range(0.0, 1.0).verdict()?;
/// assert!(!outcome.passed());
/// assert!(outcome.reason().contains("the mean is off by -"));
/// # Ok::<(), trueflight_gate::check::CheckError>(())
/// ```
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Outcome {
    /// The check's name.
    pub name: String,
    /// The probability that a correct estimator fails, all values together.
    pub alpha: f64,
    /// The names of the values, where they are channels of a case; empty otherwise.
    pub channels: Vec<String>,
    /// Judgement of each value of a draw.
    pub values: Vec<Judgement>,
}

impl Outcome {
    /// Fail if any value fails, pass if all pass.
    pub fn verdict(&self) -> Verdict {
        Verdict::worst(self.values.iter().map(|value| value.verdict))
    }

    /// Returns whether all values pass.
    pub fn passed(&self) -> bool {
        self.verdict() == Verdict::Pass
    }

    /// The name of a value.
    fn value(&self, index: usize) -> String {
        self.channels.get(index).cloned().unwrap_or_else(|| format!("value {index}"))
    }

    /// The reason why it does not pass, in words; empty for a plain pass.
    pub fn reason(&self) -> String {
        let verdict = self.verdict();
        let alike = self.values.iter().enumerate().filter(|(_, value)| value.verdict == verdict);
        let reasons = alike.filter(|(_, value)| !value.reason.is_empty());
        let many = self.values.len() > 1;
        let said = reasons.map(|(index, value)| {
            if many {
                format!("{}: {}", self.value(index), value.reason)
            } else {
                value.reason.clone()
            }
        });
        let mut said: Vec<String> = said.collect();
        let count = said.len();
        if count > TOLD {
            said.truncate(TOLD);
            said.push(format!("and {} others", count - TOLD));
        }
        said.join("; ")
    }

    /// Panics unless all values pass, with the words of [`Outcome`]'s display.
    ///
    /// # Panics
    ///
    /// The verdict is fail or inconclusive.
    #[track_caller]
    pub fn assert_pass(&self) {
        assert!(self.passed(), "check {self}");
    }
}

/// Formats the lines of `trueflight judge`, under a line with the verdict.
impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let reason = self.reason();
        write!(f, "`{}`: {}", self.name, self.verdict().word())?;
        if !reason.is_empty() {
            write!(f, ": {reason}")?;
        }
        // With too many values to display, those that decide come first.
        let verdict = self.verdict();
        let all = || self.values.iter().enumerate();
        let mut judgements: Vec<(usize, &Judgement)> = all().collect();
        if judgements.len() > TOLD {
            let is_it = |(_, value): &(usize, &Judgement)| value.verdict == verdict;
            judgements = all().filter(is_it).chain(all().filter(|other| !is_it(other))).collect();
        }
        for (index, value) in judgements.iter().take(TOLD) {
            let name = if self.values.len() > 1 { self.value(*index) } else { self.name.clone() };
            for (word, text) in value.lines(&name) {
                write!(f, "\n  {word:10}{text}")?;
            }
        }
        match judgements.len().saturating_sub(TOLD) {
            0 => Ok(()),
            rest => write!(f, "\n  and {rest} other values"),
        }
    }
}

/// Reason why a check has no verdict, with the name of the check.
#[derive(Debug)]
pub struct CheckError {
    /// Name of the check.
    pub check: String,
    /// The reason.
    pub fault: CheckFault,
}

/// Reason why a check has no verdict.
#[derive(Debug)]
#[non_exhaustive]
pub enum CheckFault {
    /// The mean of a correct draw is not given.
    NoTruth,
    /// The claim is invalid.
    Claim(ClaimError),
    /// A draw has no values.
    NoValues,
    /// A draw has more values than are judged together: their number.
    TooManyValues(usize),
    /// The property has another number of values than a draw.
    Values {
        /// The property.
        what: &'static str,
        /// Number of numbers that were given.
        actual: usize,
        /// Number of values of a draw.
        expected: usize,
    },
    /// A draw has another number of values than the case has channels.
    Channels {
        /// Number of values of a draw.
        actual: usize,
        /// Names of the channels.
        channels: Vec<String>,
        /// Numbers of values that a draw may have, in words.
        expected: String,
    },
    /// A property takes another number of numbers.
    Count {
        /// The property.
        what: &'static str,
        /// Number of numbers that were given.
        actual: usize,
        /// Numbers that it takes, in words.
        expected: &'static str,
    },
    /// A number is not whole, or out of bounds.
    Whole {
        /// The property.
        what: &'static str,
        /// The number.
        value: f64,
        /// Smallest valid number.
        min: u64,
        /// Largest valid number.
        max: u64,
    },
    /// A property is given by a number and by theory.
    Twice(&'static str),
    /// The number of lookups is claimed, but draws come without.
    NoLookups,
    /// Draws come with lookups, but there is no claim on them.
    NoLookupsWanted,
    /// There are more or fewer lookups than draws.
    Lookups {
        /// Number of lookups.
        actual: usize,
        /// Number of draws.
        expected: usize,
    },
    /// The case could not be read; the message says why.
    Case(String),
    /// The estimator panicked.
    Panicked {
        /// Number of the draw, counted from 0.
        draw: u64,
        /// Seed of the check.
        seed: u64,
        /// Message of the panic.
        message: String,
    },
    /// The last draw is not whole.
    Ragged {
        /// Number of numbers.
        actual: usize,
        /// Number of values of a draw.
        expected: usize,
    },
    /// There are no draws.
    NoDraws,
}

impl CheckFault {
    /// Adds the name of the check.
    pub(super) fn of(self, check: &str) -> CheckError {
        CheckError { check: check.to_owned(), fault: self }
    }
}

impl Error for CheckError {}

impl fmt::Display for CheckError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "check `{}`: {}", self.check, self.fault)
    }
}

impl fmt::Display for CheckFault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::NoTruth => f.write_str(
                "the truth is not known; give it by .truth(…), or by .of(case, estimator, σ̂)",
            ),
            Self::Claim(error) => error.fmt(f),
            Self::NoValues => f.write_str("a draw has no values; return one at least"),
            Self::TooManyValues(values) => {
                write!(f, "a draw has {values} values; {MAX_VALUES} are judged together at most")
            }
            Self::Values { what, actual, expected } => {
                let (actual, expected) = (counted(*actual, "number"), counted(*expected, "value"));
                write!(
                    f,
                    "{actual} for the {what}, but a draw has {expected}; give one for each value, or one for all"
                )
            }
            Self::Channels { actual, channels, expected } => {
                let names = match &channels[..] {
                    [one] if one.is_empty() => "its only one".to_owned(),
                    _ => channels.join(", "),
                };
                let (actual, all) = (counted(*actual, "value"), counted(channels.len(), "channel"));
                write!(f, "a draw has {actual}, but the case has {all} ({names}); give draws of {expected}")
            }
            Self::Count { what, actual, expected } => {
                write!(f, "{what} takes {expected}, but was given {}", counted(*actual, "number"))
            }
            Self::Whole { what, value, min, max } => {
                let value = number(*value);
                write!(f, "{what} = {value} is not a whole number from {min} to {max}; give another")
            }
            Self::Twice(what) => write!(
                f,
                "the {what} is given twice, by a number and by .of(…); leave one of them out, or add .mean_only()"
            ),
            Self::NoLookups => f.write_str(
                "a draw does not tell its lookups; return (value, lookups), or leave .lookups(…) out",
            ),
            Self::NoLookupsWanted => f.write_str(
                "nothing is known of the lookups; give .lookups(mean, variance), or push draws alone",
            ),
            Self::Lookups { actual, expected } => {
                write!(f, "{actual} lookups for {expected} draws; give one for each draw")
            }
            Self::Case(message) => f.write_str(message),
            Self::Panicked { draw, seed, message } => {
                write!(f, "the estimator panicked in draw {draw} (seed {seed}): {message}")
            }
            Self::Ragged { actual, expected } => write!(
                f,
                "{actual} numbers are no whole number of draws of {expected} values; push whole draws"
            ),
            Self::NoDraws => f.write_str("there are no draws; make one at least"),
        }
    }
}

/// A number of things in words.
fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// Panics unless a check passes.
#[track_caller]
pub(super) fn assert_pass(outcome: &Result<Outcome, CheckError>) {
    match outcome {
        Ok(outcome) => outcome.assert_pass(),
        Err(error) => panic!("{error}"),
    }
}

//! Why a check has no verdict.

use crate::session::ClaimError;
use numeric::digits::number;

/// A number of things in words.
fn counted(count: usize, thing: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {thing}{plural}")
}

/// Names in a list; of one channel without a name what it is.
fn named(channels: &[String]) -> String {
    match channels {
        [one] if one.is_empty() => "its only one".to_owned(),
        _ => channels.join(", "),
    }
}

/// Why a check has no verdict.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckError {
    /// Nothing says what the mean of a correct draw is.
    #[error(
        "check `{name}`: the truth is not known; give it by .truth(…), or by .of(case, estimator, σ̂)"
    )]
    NoTruth {
        /// The check.
        name: String,
    },
    /// What was said makes no sense.
    #[error("check `{name}`: {source}")]
    Claim {
        /// The check.
        name: String,
        /// What is wrong with it.
        source: Box<ClaimError>,
    },
    /// A draw without values.
    #[error("check `{name}`: a draw has no values; return one at least")]
    NoValues {
        /// The check.
        name: String,
    },
    /// A draw with more values than are judged together.
    #[error("check `{name}`: a draw has {values} values; {most} are judged together at most")]
    TooManyValues {
        /// The check.
        name: String,
        /// Number of values of a draw.
        values: usize,
        /// Largest number of values.
        most: usize,
    },
    /// Numbers for another number of values than a draw has.
    #[error(
        "check `{name}`: {} for the {what}, but a draw has {}; give one for each value, or one for all",
        counted(*found, "number"),
        counted(*wanted, "value")
    )]
    Values {
        /// The check.
        name: String,
        /// What was given.
        what: &'static str,
        /// How many numbers.
        found: usize,
        /// How many values a draw has.
        wanted: usize,
    },
    /// Another number of values than the case has channels.
    #[error(
        "check `{name}`: a draw has {}, but the case has {} ({}); give draws of {wanted}",
        counted(*found, "value"),
        counted(channels.len(), "channel"),
        named(channels)
    )]
    Channels {
        /// The check.
        name: String,
        /// Number of values of a draw.
        found: usize,
        /// The names of the case's channels.
        channels: Vec<String>,
        /// Numbers of values that are possible, in words.
        wanted: String,
    },
    /// Another number of numbers than a property takes.
    #[error("check `{name}`: {what} takes {wanted}, but was given {}", counted(*found, "number"))]
    Count {
        /// The check.
        name: String,
        /// The property.
        what: &'static str,
        /// How many numbers were given.
        found: usize,
        /// Numbers that the property takes, in words.
        wanted: &'static str,
    },
    /// A number that is not whole, or out of bounds.
    #[error("check `{name}`: {what} = {} is not a whole number from {min} to {max}; give another", number(*value))]
    Whole {
        /// The check.
        name: String,
        /// The property.
        what: &'static str,
        /// The number.
        value: f64,
        /// Smallest number that the property takes.
        min: u64,
        /// Largest number that the property takes.
        max: u64,
    },
    /// What theory says was given beside numbers.
    #[error(
        "check `{name}`: the {what} is given twice, by a number and by .of(…); leave one of them out, or add .mean_only()"
    )]
    Twice {
        /// The check.
        name: String,
        /// What.
        what: &'static str,
    },
    /// What is claimed of lookups cannot be judged.
    #[error(
        "check `{name}`: a draw does not tell its lookups; return (value, lookups), or leave .lookups(…) out"
    )]
    NoLookups {
        /// The check.
        name: String,
    },
    /// Lookups that nobody asked for.
    #[error(
        "check `{name}`: nothing is known of the lookups; give .lookups(mean, variance), or push draws alone"
    )]
    NoLookupsWanted {
        /// The check.
        name: String,
    },
    /// Another number of lookups than of draws.
    #[error("check `{name}`: {found} lookups for {wanted} draws; give one for each draw")]
    Lookups {
        /// The check.
        name: String,
        /// How many lookups.
        found: usize,
        /// How many draws.
        wanted: usize,
    },
    /// The case could not be read.
    #[error("check `{name}`: {message}")]
    Case {
        /// The check.
        name: String,
        /// What is wrong with it, and what would be right.
        message: String,
    },
    /// The closure panicked.
    #[error("check `{name}`: the estimator panicked in draw {draw} (seed {seed}): {message}")]
    Panicked {
        /// The check.
        name: String,
        /// Which draw, counted from 0.
        draw: u64,
        /// The seed that leads there again.
        seed: u64,
        /// What it said.
        message: String,
    },
    /// Draws that do not fill their last one.
    #[error(
        "check `{name}`: {found} numbers are no whole number of draws of {wanted} values; push whole draws"
    )]
    Ragged {
        /// The check.
        name: String,
        /// How many numbers.
        found: usize,
        /// How many values a draw has.
        wanted: usize,
    },
    /// There are no draws.
    #[error("check `{name}`: there are no draws; make one at least")]
    NoDraws {
        /// The check.
        name: String,
    },
}

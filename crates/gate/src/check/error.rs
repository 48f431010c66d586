//! Why a check has no verdict.
#![allow(missing_docs)] // messages name the fields

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
    NoTruth { name: String },
    /// What was said makes no sense.
    #[error("check `{name}`: {source}")]
    Claim { name: String, source: Box<ClaimError> },
    /// A draw without values.
    #[error("check `{name}`: a draw has no values; return one at least")]
    NoValues { name: String },
    /// A draw with more values than are judged together.
    #[error("check `{name}`: a draw has {values} values; {most} are judged together at most")]
    TooManyValues { name: String, values: usize, most: usize },
    /// Numbers for another number of values than a draw has.
    #[error(
        "check `{name}`: {} for the {what}, but a draw has {}; give one for each value, or one for all",
        counted(*found, "number"),
        counted(*wanted, "value")
    )]
    Values { name: String, what: &'static str, found: usize, wanted: usize },
    /// Another number of values than the case has channels.
    #[error(
        "check `{name}`: a draw has {}, but the case has {} ({}); give draws of {wanted}",
        counted(*found, "value"),
        counted(channels.len(), "channel"),
        named(channels)
    )]
    Channels { name: String, found: usize, channels: Vec<String>, wanted: String },
    /// Another number of numbers than a property takes.
    #[error("check `{name}`: {what} takes {wanted}, but was given {}", counted(*found, "number"))]
    Count { name: String, what: &'static str, found: usize, wanted: &'static str },
    /// A number that is not whole, or out of bounds.
    #[error("check `{name}`: {what} = {} is not a whole number from {min} to {max}; give another", number(*value))]
    Whole { name: String, what: &'static str, value: f64, min: u64, max: u64 },
    /// What theory says was given beside numbers.
    #[error(
        "check `{name}`: the {what} is given twice, by a number and by .of(…); leave one of them out, or add .mean_only()"
    )]
    Twice { name: String, what: &'static str },
    /// What is claimed of lookups cannot be judged.
    #[error(
        "check `{name}`: a draw does not tell its lookups; return (value, lookups), or leave .lookups(…) out"
    )]
    NoLookups { name: String },
    /// Lookups that nobody asked for.
    #[error(
        "check `{name}`: nothing is known of the lookups; give .lookups(mean, variance), or push draws alone"
    )]
    NoLookupsWanted { name: String },
    /// Another number of lookups than of draws.
    #[error("check `{name}`: {found} lookups for {wanted} draws; give one for each draw")]
    Lookups { name: String, found: usize, wanted: usize },
    /// The case could not be read.
    #[error("check `{name}`: {message}")]
    Case { name: String, message: String },
    /// The closure panicked.
    #[error("check `{name}`: the estimator panicked in draw {draw} (seed {seed}): {message}")]
    Panicked { name: String, draw: u64, seed: u64, message: String },
    /// Draws that do not fill their last one.
    #[error(
        "check `{name}`: {found} numbers are no whole number of draws of {wanted} values; push whole draws"
    )]
    Ragged { name: String, found: usize, wanted: usize },
    /// There are no draws.
    #[error("check `{name}`: there are no draws; make one at least")]
    NoDraws { name: String },
}

//! Reasons of verdicts: an enum for programs, with its numbers, and one sentence each for people.
#![allow(missing_docs)] // the fields are the numbers of the sentence above them

use std::borrow::Cow;

use super::ground::EFFECTIVE;
use super::quantity::Ground;
use crate::deviation::{Deviation, signed_percent};
use crate::stats::verdict::BLOCK;
use numeric::digits::{enough, percent};

/// Name of a quantity in a sentence, as in `the mean`.
pub type What = Cow<'static, str>;

/// Reason of a verdict.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// The evidence refutes the expected value. `tolerance` is one that was asked for, where the deviation is below it;
    /// `remark` is on the unit of the deviation.
    #[error("{what} is off by {off}{remark} (ln E = {ln_e:.1} ≥ {limit:.1}){}", below(*tolerance))]
    Off {
        what: What,
        off: Deviation,
        remark: String,
        ln_e: f64,
        limit: f64,
        tolerance: Option<f64>,
    },
    /// The deviation is obvious and within the tolerance that was asked for.
    #[error("{what} is off by {off}, within the tolerance of {tolerance:.1e} that was asked for")]
    Tolerated { what: What, off: Deviation, tolerance: f64 },
    /// The deviation is obvious, but what is known of the draws does not allow a failure. `excluded` is the bias that the
    /// gate excludes, where it has decided.
    #[error(
        "{what} looks off by {off}{}, but {}{}",
        if *are_alike { ", and all draws are alike" } else { "" },
        not_shown(what, off, *ground),
        excluded_bias(*excluded)
    )]
    LooksOff {
        what: What,
        off: Deviation,
        are_alike: bool,
        ground: Option<Ground>,
        excluded: Option<f64>,
    },
    /// The draws do not decide. `needed` is the number of draws that the tolerance needs.
    #[error(
        "{what} is undecided after {draws} draws; a tolerance of {tolerance:.2e} needs {needed:.1e}"
    )]
    Undecided { what: What, draws: u64, tolerance: f64, needed: f64 },
    /// No first draws show the spread that a tolerance is chosen by.
    #[error("{what} is undecided after {draws} draws, too few to choose a tolerance by{}", untested(*tolerance))]
    NoTolerance { what: What, draws: u64, tolerance: Option<f64> },
    /// A bound on the kurtosis needs more draws to bound the variance.
    #[error(
        "the spread of {what} is not known: with a kurtosis of {kurtosis} it needs a first block of draws, {needed:.0} of \
         them or more, and others after it; there are {draws}{}",
        untested(*tolerance)
    )]
    FewForKurtosis { what: What, kurtosis: f64, needed: f64, draws: u64, tolerance: Option<f64> },
    /// The draws show a larger kurtosis than was assumed.
    #[error(
        "the spread of {what} is not known: the draws show a kurtosis of {shown:.0}, more than the {assumed:.0} that was \
         assumed; give {}{}",
        cure(what),
        untested(*tolerance)
    )]
    HeavyTails { what: What, shown: f64, assumed: f64, tolerance: Option<f64> },
    /// Too few draws carry the spread.
    #[error(
        "the spread of {what} is not known: {carry} of {draws} draws carry it, and {EFFECTIVE} of more than {BLOCK} are \
         needed; give {}{}",
        cure(what),
        untested(*tolerance)
    )]
    FewCarry { what: What, carry: f64, draws: u64, tolerance: Option<f64> },
    /// Too few draws are planned. Where no number of draws suffices, the prediction's own error `floor` is the reason.
    #[error("{}", too_few_planned(what, *needed, *floor))]
    TooFewPlanned { what: What, needed: f64, floor: f64 },
    /// Nothing can be tested, whatever the draws say.
    #[error("{what} cannot be tested: {why}")]
    Untestable { what: What, why: String },
    /// The bias that was declared is shown.
    #[error("biased-as-expected: {}", fine_percent(*.0))]
    BiasShown(f64),
    /// The draws ended before the bias that was declared was shown.
    #[error("the bias is not shown after {0} draws")]
    BiasNotShown(u64),
    /// A bias was declared, and the evidence for it is too small.
    #[error("expected a bias, found {} (ln E = {ln_e:.1} of {limit:.1})", fine_percent(*bias))]
    SmallBias { bias: f64, ln_e: f64, limit: f64 },
    /// A bias was declared, and every draw is right.
    #[error("expected a bias, found none")]
    NoBias,
    /// The bias that was declared is shown in another channel.
    #[error("biased elsewhere")]
    BiasedElsewhere,
    /// Draws are NaN or infinite.
    #[error("draws are not finite numbers")]
    NotFinite,
    /// The mean and single draws are off by more than rounding explains.
    #[error(
        "{what} is off by {off}; a draw by up to {}, of which rounding explains {}",
        percent(*largest),
        percent(*bound)
    )]
    MeanOff { what: What, off: Deviation, largest: f64, bound: f64 },
    /// A draw is off by more than rounding explains.
    #[error("{what} is off by {} in a draw; rounding explains {}", percent(*largest), percent(*bound))]
    DrawOff { what: What, largest: f64, bound: f64 },
    /// A draw takes another number of lookups than all draws take.
    #[error("the number of lookups is off by {0:.0} in a draw; theory has one number for all")]
    LookupsOff(f64),
    /// The draws ended before the number that a p-value needs.
    #[error("{what}: cut after {draws} of {fixed} draws")]
    Cut { what: What, draws: u64, fixed: u64 },
    /// There are too few draws for a p-value.
    #[error("{0} has too few draws for a test")]
    TooFew(What),
    /// The distribution of the draws is refuted, with p in words.
    #[error("{what} differs from theory: p = {p}{}", in_parentheses(details))]
    Differs { what: What, p: String, details: String },
    /// A pass relies on a variance that is not tested.
    #[error("variance assumed")]
    VarianceAssumed,
    /// A pass relies on a variance that does not pass.
    #[error("the mean relies on a variance that does not pass")]
    VarianceOpen,
    /// A failure rests on a variance that is refuted as too small.
    #[error("{0} rests on a variance that is refuted")]
    RestsOnVariance(What),
    /// The squares about the truth are too large because the mean is off.
    #[error(
        "squares about the truth are too large by {}, for the mean is off; about the mean of the draws by {}",
        signed_percent(*about_truth),
        signed_percent(*about_mean)
    )]
    SquaresByMean { about_truth: f64, about_mean: f64 },
    /// The mean changes on the way: from a draw to before another one, or to the end.
    #[error(
        "the mean changes: from draw {from} {} it is off by {off}, {z:+.1} standard errors from all other draws",
        to.map_or("on".to_owned(), |to| format!("to draw {to}"))
    )]
    Changes { from: u64, to: Option<u64>, off: Deviation, z: f64 },
    /// The draws depend on each other.
    #[error("the draws are not independent: {0}")]
    Dependent(String),
    /// A quantity is not judged because the draws depend on each other.
    #[error("{0} is not judged: the draws are not independent")]
    NotJudged(What),
    /// A reason that adds another.
    #[error("{0}; {1}")]
    Both(Box<Self>, Box<Self>),
}

/// Grounds that would let a quantity fail.
fn cure(what: &str) -> &'static str {
    match what {
        "the variance" => "the kurtosis or the range",
        _ => "the variance, the range or the largest kurtosis",
    }
}

fn below(tolerance: Option<f64>) -> String {
    let why = "which is what a pass must exclude: a bias that is shown fails";
    tolerance.map_or(String::new(), |asked| format!("; below the tolerance of {asked:.1e}, {why}"))
}

fn untested(tolerance: Option<f64>) -> String {
    let untested = |asked| format!("; the tolerance of {asked:.1e} is not tested without that");
    tolerance.map_or(String::new(), untested)
}

fn excluded_bias(excluded: Option<f64>) -> String {
    let cure = "give a tolerance to accept a smaller one";
    excluded.map_or(String::new(), |bias| format!("; a bias of {bias:.2e} is excluded: {cure}"))
}

fn not_shown(what: &str, off: &Deviation, ground: Option<Ground>) -> String {
    let draws = format!("{} {}", off.draws, off.unit);
    match ground {
        Some(Ground::Variance(_)) => format!("{draws} of the variance given do not show it"),
        Some(Ground::Kurtosis(_)) => format!("{draws} of the kurtosis given do not show it"),
        Some(Ground::Shown) => format!("no number of draws shows it without {}", cure(what)),
        None => format!("{draws} of the range given do not show it: give more, or the variance"),
    }
}

fn too_few_planned(what: &str, needed: f64, floor: f64) -> String {
    if needed.is_finite() {
        format!("{what} needs {} draws", enough(needed))
    } else {
        format!("the prediction of {what} is known to {floor:.0e} only")
    }
}

fn in_parentheses(details: &str) -> String {
    if details.is_empty() { String::new() } else { format!(" ({details})") }
}

/// A relative difference in percent with two decimals, or in powers of ten where it is small.
fn fine_percent(difference: f64) -> String {
    let percent = 100.0 * difference;
    if percent.abs() >= 0.01 { format!("{percent:+.2} %") } else { format!("{percent:+.1e} %") }
}

/// Words of a reason, or none: as files have them.
#[cfg(feature = "serde")]
#[allow(clippy::ref_option)] // serde asks for it
pub(super) fn words<S: serde::Serializer>(
    reason: &Option<Reason>,
    to: S,
) -> Result<S::Ok, S::Error> {
    to.serialize_str(&reason.as_ref().map_or(String::new(), Reason::to_string))
}

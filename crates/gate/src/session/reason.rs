//! Reasons of verdicts: an enum for programs, with its numbers, and one sentence each for people.

use std::borrow::Cow;
use std::fmt;

use super::ground::EFFECTIVE;
use super::quantity::VarianceBound;
use crate::CheckId;
use crate::deviation::{Deviation, signed_percent};
use crate::stats::verdict::BLOCK;
use numeric::digits::{enough, percent};

/// Name of a quantity in a sentence, as in `the mean`.
pub type What = Cow<'static, str>;

/// Reason of a verdict about the quantity `what`.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Reason {
    /// The evidence refutes the expected value.
    Off {
        /// The quantity.
        what: What,
        /// The deviation.
        off: Deviation,
        /// Words on the unit of the deviation; may be empty.
        remark: String,
        /// ln E.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        ln_e: f64,
        /// ln E at which it fails.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        limit: f64,
        /// Given tolerance, if the deviation is below it.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        tolerance: Option<f64>,
    },
    /// The deviation is obvious, but within the given tolerance.
    Tolerated {
        /// The quantity.
        what: What,
        /// The deviation.
        off: Deviation,
        /// ε, as given.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        tolerance: f64,
    },
    /// The deviation is obvious, but the grounds do not allow a failure.
    LooksOff {
        /// The check.
        check: CheckId,
        /// The quantity.
        what: What,
        /// The deviation.
        off: Deviation,
        /// True if all draws are equal.
        are_alike: bool,
        /// Known bound on the variance; `None` for a range alone.
        ground: Option<VarianceBound>,
        /// Bias that the gate excludes, where it has decided.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        excluded: Option<f64>,
    },
    /// The draws do not decide.
    Undecided {
        /// The quantity.
        what: What,
        /// Number of draws.
        draws: u64,
        /// ε.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        tolerance: f64,
        /// Number of draws that the tolerance needs.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        needed: f64,
    },
    /// The draws do not show the variance that a decision needs.
    UnknownSpread {
        /// The check.
        check: CheckId,
        /// The quantity.
        what: What,
        /// Number of draws.
        draws: u64,
        /// Given tolerance, which is then not tested.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        tolerance: Option<f64>,
        /// What is missing.
        missing: Missing,
    },
    /// Too few draws are planned.
    TooFewPlanned {
        /// The quantity.
        what: What,
        /// Number of draws that a pass needs; infinite where the prediction is not accurate enough for any.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        needed: f64,
        /// Relative error of the prediction.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        floor: f64,
    },
    /// Nothing can be tested with any draws.
    Untestable {
        /// The quantity.
        what: What,
        /// The reason in words.
        why: String,
    },
    /// The declared bias is shown: its relative size.
    BiasShown(#[cfg_attr(feature = "serde", serde(with = "crate::extended"))] f64),
    /// The draws ended before the declared bias was shown: their number.
    BiasNotShown(u64),
    /// A bias was declared, and the evidence for it is too small.
    SmallBias {
        /// Relative size of the bias.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        bias: f64,
        /// ln E.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        ln_e: f64,
        /// ln E at which it is shown.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        limit: f64,
    },
    /// The limit of time or draws came before the first draw.
    NothingDrawn,
    /// A bias was declared, but every draw is right.
    NoBias,
    /// The declared bias is shown in another channel.
    BiasedElsewhere,
    /// Blocks or streams differ because the mean or the variance is off: no evidence of a dependence.
    Follows {
        /// Reason that the blocks or streams differ.
        of: Box<Self>,
        /// Quantity that is off.
        from: What,
    },
    /// Draws are NaN or infinite.
    NotFinite,
    /// The mean and single draws deviate by more than rounding explains.
    MeanOff {
        /// The quantity.
        what: What,
        /// Deviation of the mean.
        off: Deviation,
        /// Largest relative deviation of a draw.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        largest: f64,
        /// Relative deviation that rounding explains.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        bound: f64,
    },
    /// A draw deviates by more than rounding explains.
    DrawOff {
        /// The quantity.
        what: What,
        /// Largest relative deviation of a draw.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        largest: f64,
        /// Relative deviation that rounding explains.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        bound: f64,
    },
    /// A draw takes another number of lookups than all draws must: the largest difference.
    LookupsOff(#[cfg_attr(feature = "serde", serde(with = "crate::extended"))] f64),
    /// The draws ended before the number that a p-value needs.
    Cut {
        /// The distribution.
        what: What,
        /// Number of draws.
        draws: u64,
        /// Number of draws that the p-value needs.
        fixed: u64,
    },
    /// There are too few draws for a p-value of this distribution.
    TooFew(What),
    /// The distribution of the draws is refuted.
    Differs {
        /// The distribution.
        what: What,
        /// The p-value in words.
        p: String,
        /// Numbers behind it in words; may be empty.
        details: String,
    },
    /// A pass relies on a variance that is not tested.
    VarianceAssumed,
    /// A pass relies on a variance that does not pass.
    VarianceOpen,
    /// A failure of this quantity rests on a variance that is refuted as too small.
    RestsOnVariance(What),
    /// The squares about the truth are too large because the mean deviates.
    SquaresByMean {
        /// Relative excess of the mean square about the truth.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        about_truth: f64,
        /// Relative excess of the variance about the mean of the draws.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        about_mean: f64,
    },
    /// The mean changes within the draws.
    Changes {
        /// First draw of the part that differs.
        from: u64,
        /// Draw after the last one of that part; `None` for the end.
        to: Option<u64>,
        /// Deviation of that part.
        off: Deviation,
        /// Distance from all other draws in standard errors.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        z: f64,
    },
    /// The draws depend on each other, as the words explain.
    Dependent(String),
    /// The quantity is not judged because the draws depend on each other.
    NotJudged(What),
    /// A reason that adds another.
    Both(Box<Self>, Box<Self>),
}

/// Evidence that is missing to know a variance.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Missing {
    /// First draws to choose a tolerance by.
    FirstDraws,
    /// Enough draws to bound the variance by a kurtosis.
    DrawsOfKurtosis {
        /// The kurtosis that was given.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        kurtosis: f64,
        /// Number of draws that it needs.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        needed: f64,
    },
    /// Tails that are as light as assumed.
    LightTails {
        /// Kurtosis that the draws show.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        shown: f64,
        /// Kurtosis that was assumed.
        #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
        assumed: f64,
    },
    /// Draws that carry the variance: their number.
    Carriers(#[cfg_attr(feature = "serde", serde(with = "crate::extended"))] f64),
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Off { what, off, remark, ln_e, limit, tolerance } => {
                let below = below(*tolerance);
                write!(f, "{what} is off by {off}{remark} (ln E = {ln_e:.1} ≥ {limit:.1}){below}")
            }
            Self::Tolerated { what, off, tolerance } => {
                write!(
                    f,
                    "{what} is off by {off}, within the tolerance of {tolerance:.1e} that was asked for"
                )
            }
            Self::LooksOff { check, what, off, are_alike, ground, excluded } => {
                let alike = if *are_alike { ", and all draws are alike" } else { "" };
                let (why, excluded) = (not_shown(*check, off, *ground), excluded_bias(*excluded));
                write!(f, "{what} looks off by {off}{alike}, but {why}{excluded}")
            }
            Self::Undecided { what, draws, tolerance, needed } => write!(
                f,
                "{what} is undecided after {draws} draws; a tolerance of {tolerance:.2e} needs {needed:.1e}"
            ),
            Self::UnknownSpread { check, what, draws, tolerance, missing } => {
                missing.write(f, (*check, what), *draws)?;
                tolerance.map_or(Ok(()), |requested| {
                    write!(f, "; the tolerance of {requested:.1e} is not tested without that")
                })
            }
            Self::TooFewPlanned { what, needed, .. } if needed.is_finite() => {
                write!(f, "{what} needs {} draws", enough(*needed))
            }
            Self::TooFewPlanned { what, floor, .. } => {
                write!(f, "the prediction of {what} is known to {floor:.0e} only")
            }
            Self::Untestable { what, why } => write!(f, "{what} cannot be tested: {why}"),
            Self::BiasShown(bias) => write!(f, "biased-as-expected: {}", fine_percent(*bias)),
            Self::BiasNotShown(draws) => write!(f, "the bias is not shown after {draws} draws"),
            Self::SmallBias { bias, ln_e, limit } => {
                let bias = fine_percent(*bias);
                write!(f, "expected a bias, found {bias} (ln E = {ln_e:.1} of {limit:.1})")
            }
            Self::NothingDrawn => {
                f.write_str("the limit of time or draws came before the first draw")
            }
            Self::NoBias => f.write_str("expected a bias, found none"),
            Self::BiasedElsewhere => f.write_str("biased elsewhere"),
            Self::Follows { of, from } => write!(f, "{of}, which follows where {from} is off"),
            Self::NotFinite => f.write_str("draws are not finite numbers"),
            Self::MeanOff { what, off, largest, bound } => {
                let (largest, bound) = (percent(*largest), percent(*bound));
                write!(
                    f,
                    "{what} is off by {off}; a draw by up to {largest}, of which rounding explains {bound}"
                )
            }
            Self::DrawOff { what, largest, bound } => {
                let (largest, bound) = (percent(*largest), percent(*bound));
                write!(f, "{what} is off by {largest} in a draw; rounding explains {bound}")
            }
            Self::LookupsOff(off) => write!(
                f,
                "the number of lookups is off by {off:.0} in a draw; theory has one number for all"
            ),
            Self::Cut { what, draws, fixed } => {
                write!(f, "{what}: cut after {draws} of {fixed} draws")
            }
            Self::TooFew(what) => write!(f, "{what} has too few draws for a test"),
            Self::Differs { what, p, details } => {
                write!(f, "{what} differs from theory: p = {p}")?;
                if details.is_empty() { Ok(()) } else { write!(f, " ({details})") }
            }
            Self::VarianceAssumed => f.write_str("variance assumed"),
            Self::VarianceOpen => f.write_str("the mean relies on a variance that does not pass"),
            Self::RestsOnVariance(what) => write!(f, "{what} rests on a variance that is refuted"),
            Self::SquaresByMean { about_truth, about_mean } => {
                let (truth, mean) = (signed_percent(*about_truth), signed_percent(*about_mean));
                write!(
                    f,
                    "squares about the truth are too large by {truth}, for the mean is off; about the mean of the draws by {mean}"
                )
            }
            Self::Changes { from, to, off, z } => {
                let to = to.map_or("on".to_owned(), |to| format!("to draw {to}"));
                write!(
                    f,
                    "the mean changes: from draw {from} {to} it is off by {off}, {z:+.1} standard errors from all other draws"
                )
            }
            Self::Dependent(how) => write!(f, "the draws are not independent: {how}"),
            Self::NotJudged(what) => {
                write!(f, "{what} is not judged: the draws are not independent")
            }
            Self::Both(one, other) => write!(f, "{one}; {other}"),
        }
    }
}

impl Missing {
    fn write(
        &self,
        f: &mut fmt::Formatter,
        (check, what): (CheckId, &str),
        draws: u64,
    ) -> fmt::Result {
        match self {
            Self::FirstDraws => {
                write!(
                    f,
                    "{what} is undecided after {draws} draws, too few to choose a tolerance by"
                )
            }
            Self::DrawsOfKurtosis { kurtosis, needed } => write!(
                f,
                "the spread of {what} is not known: with a kurtosis of {kurtosis} it needs a first block of draws, \
                 {needed:.0} of them or more, and others after it; there are {draws}"
            ),
            Self::LightTails { shown, assumed } => write!(
                f,
                "the spread of {what} is not known: the draws show a kurtosis of {shown:.0}, more than the {assumed:.0} \
                 that was assumed; give {}",
                cure(check)
            ),
            Self::Carriers(carry) => write!(
                f,
                "the spread of {what} is not known: {carry} of {draws} draws carry it, and {EFFECTIVE} of more than \
                 {BLOCK} are needed; give {}",
                cure(check)
            ),
        }
    }
}

/// Grounds that would let a quantity fail.
fn cure(check: CheckId) -> &'static str {
    match check {
        CheckId::Variance => "the kurtosis or the range",
        _ => "the variance, the range or the largest kurtosis",
    }
}

fn below(tolerance: Option<f64>) -> String {
    let why = "which is what a pass must exclude: a bias that is shown fails";
    tolerance.map_or(String::new(), |requested| {
        format!("; below the tolerance of {requested:.1e}, {why}")
    })
}

fn excluded_bias(excluded: Option<f64>) -> String {
    let cure = "give a tolerance to accept a smaller one";
    excluded.map_or(String::new(), |bias| format!("; a bias of {bias:.2e} is excluded: {cure}"))
}

fn not_shown(check: CheckId, off: &Deviation, ground: Option<VarianceBound>) -> String {
    let draws = format!("{} {}", off.draws, off.unit.word());
    match ground {
        Some(VarianceBound::Variance(_)) => format!("{draws} of the variance given do not show it"),
        Some(VarianceBound::Kurtosis(_)) => format!("{draws} of the kurtosis given do not show it"),
        Some(VarianceBound::Shown) => {
            format!("no number of draws shows it without {}", cure(check))
        }
        None => format!("{draws} of the range given do not show it: give more, or the variance"),
    }
}

/// A relative difference in percent with two decimals, or in powers of ten where it is small.
fn fine_percent(difference: f64) -> String {
    let percent = 100.0 * difference;
    if percent.abs() >= 0.01 { format!("{percent:+.2} %") } else { format!("{percent:+.1e} %") }
}

/// Words of a reason, or nothing, as files store them.
#[cfg(feature = "serde")]
#[allow(clippy::ref_option)] // serde asks for it
pub(super) fn words<S: serde::Serializer>(
    reason: &Option<Reason>,
    to: S,
) -> Result<S::Ok, S::Error> {
    to.serialize_str(&reason.as_ref().map_or(String::new(), Reason::to_string))
}

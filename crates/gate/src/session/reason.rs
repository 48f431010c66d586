//! Reasons of verdicts: an enum for programs, with its numbers, and one sentence each for people.

use std::borrow::Cow;
use std::fmt;

use super::ground::EFFECTIVE;
use super::quantity::Ground;
use crate::deviation::{Deviation, signed_percent};
use crate::stats::verdict::BLOCK;
use numeric::digits::{enough, percent};

/// Name of a quantity in a sentence, as in `the mean`.
pub type What = Cow<'static, str>;

/// Reason of a verdict.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The evidence refutes the expected value.
    Off {
        /// The quantity.
        what: What,
        /// Its deviation.
        off: Deviation,
        /// A remark on the unit of the deviation; empty for none.
        remark: String,
        /// ln E.
        ln_e: f64,
        /// ln E at which it fails.
        limit: f64,
        /// The tolerance that was asked for, where the deviation is below it.
        tolerance: Option<f64>,
    },
    /// The deviation is obvious and within the tolerance that was asked for.
    Tolerated {
        /// The quantity.
        what: What,
        /// Its deviation.
        off: Deviation,
        /// The tolerance.
        tolerance: f64,
    },
    /// The deviation is obvious, but what is known of the draws does not allow a failure.
    LooksOff {
        /// The quantity.
        what: What,
        /// Its deviation.
        off: Deviation,
        /// Whether all draws have one value.
        are_alike: bool,
        /// What is known of the spread.
        ground: Option<Ground>,
        /// The bias that the gate excludes, where it has decided.
        excluded: Option<f64>,
    },
    /// The draws do not decide.
    Undecided {
        /// The quantity.
        what: What,
        /// Number of draws.
        draws: u64,
        /// ln of the evidence for a pass from above and from below, and the ln at which it passes.
        ln_pass: [f64; 3],
        /// The tolerance.
        tolerance: f64,
        /// Number of draws that the tolerance needs.
        needed: f64,
    },
    /// The spread is not known.
    UnknownSpread {
        /// The quantity.
        what: What,
        /// What is known of the spread.
        ground: Option<Ground>,
        /// Number of draws.
        draws: u64,
        /// Number of draws that carry the spread.
        carry: f64,
        /// Kurtosis that the draws show, beside the one that was assumed, where they contradict it.
        kurtosis: Option<[f64; 2]>,
        /// Number of draws that a bound on the variance needs.
        needed: f64,
        /// The tolerance that was asked for.
        tolerance: Option<f64>,
    },
    /// Too few draws are planned.
    TooFewPlanned {
        /// The quantity.
        what: What,
        /// Number of draws that a pass needs.
        needed: f64,
        /// δ of the prediction; it is the reason where no number of draws suffices.
        floor: f64,
    },
    /// Nothing can be tested, whatever the draws say.
    Untestable {
        /// The quantity.
        what: What,
        /// Why.
        why: String,
    },
    /// The bias that was declared is shown.
    BiasShown(f64),
    /// The draws ended before the bias that was declared was shown.
    BiasNotShown(u64),
    /// A bias was declared, and none is shown.
    NoBias {
        /// The bias.
        bias: f64,
        /// ln E.
        ln_e: f64,
        /// ln E at which the bias is shown.
        limit: f64,
    },
    /// The bias that was declared is shown in another channel.
    BiasedElsewhere,
    /// Draws are NaN or infinite.
    NotFinite,
    /// The draws are not what no chance may change.
    DrawOff {
        /// The quantity.
        what: What,
        /// Deviation of its mean, where there is one.
        off: Option<Deviation>,
        /// Largest deviation of a draw.
        largest: f64,
        /// Part of the deviation that rounding explains.
        bound: f64,
    },
    /// A draw takes another number of lookups than all draws take.
    LookupsOff(f64),
    /// The draws ended before the number that a p-value needs.
    Cut {
        /// The distribution.
        what: What,
        /// Number of draws.
        draws: u64,
        /// Number of draws that the p-value needs.
        fixed: u64,
    },
    /// There are too few draws for a p-value.
    TooFew(What),
    /// The distribution of the draws is refuted.
    Differs {
        /// The distribution.
        what: What,
        /// The p-value in words.
        p: String,
        /// Details in words; empty for none.
        details: String,
    },
    /// A pass relies on a variance that is not tested.
    VarianceAssumed,
    /// A pass relies on a variance that does not pass.
    VarianceOpen,
    /// A failure rests on a variance that is refuted as too small.
    RestsOnVariance(What),
    /// The squares about the truth are too large because the mean is off.
    SquaresByMean {
        /// Relative excess about the truth.
        about_truth: f64,
        /// Relative excess about the mean of the draws.
        about_mean: f64,
    },
    /// The mean changes on the way.
    Changes {
        /// First draw of the part that differs.
        from: u64,
        /// Draw after the last one of the part; `None` for the end.
        to: Option<u64>,
        /// Deviation of the part.
        off: Deviation,
        /// Distance from all other draws in standard errors.
        z: f64,
    },
    /// The draws depend on each other.
    Dependent(String),
    /// A quantity is not judged because the draws depend on each other.
    NotJudged(What),
    /// A reason that adds another.
    Both(Box<Self>, Box<Self>),
}

/// Grounds that would let a quantity fail.
pub(super) fn cure(what: &str) -> &'static str {
    match what {
        "the variance" => "the kurtosis or the range",
        _ => "the variance, the range or the largest kurtosis",
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Off { what, off, remark, ln_e, limit, tolerance } => {
                write!(f, "{what} is off by {off}{remark} (ln E = {ln_e:.1} ≥ {limit:.1})")?;
                match tolerance {
                    Some(asked) => write!(
                        f,
                        "; below the tolerance of {asked:.1e}, which is what a pass must exclude: a bias that is \
                         shown fails"
                    ),
                    None => Ok(()),
                }
            }
            Self::Tolerated { what, off, tolerance } => write!(
                f,
                "{what} is off by {off}, within the tolerance of {tolerance:.1e} that was asked for"
            ),
            Self::LooksOff { what, off, are_alike, ground, excluded } => {
                let alike = if *are_alike { ", and all draws are alike" } else { "" };
                let (n, unit) = (off.draws, off.unit);
                write!(f, "{what} looks off by {off}{alike}, but ")?;
                match ground {
                    Some(Ground::Variance(_)) => {
                        write!(f, "{n} {unit} of the variance given do not show it")
                    }
                    Some(Ground::Kurtosis(_)) => {
                        write!(f, "{n} {unit} of the kurtosis given do not show it")
                    }
                    Some(Ground::Shown) => {
                        write!(f, "no number of draws shows it without {}", cure(what))
                    }
                    None => write!(
                        f,
                        "{n} {unit} of the range given do not show it: give more, or the variance"
                    ),
                }?;
                match excluded {
                    Some(tolerance) => write!(
                        f,
                        "; a bias of {tolerance:.2e} is excluded: give a tolerance to accept a smaller one"
                    ),
                    None => Ok(()),
                }
            }
            Self::Undecided { what, draws, tolerance, needed, .. } => write!(
                f,
                "{what} is undecided after {draws} draws; a tolerance of {tolerance:.2e} needs {needed:.1e}"
            ),
            Self::UnknownSpread { .. } => self.unknown_spread(f),
            Self::TooFewPlanned { what, needed, .. } if needed.is_finite() => {
                write!(f, "{what} needs {} draws", enough(*needed))
            }
            Self::TooFewPlanned { what, floor, .. } => {
                write!(f, "the prediction of {what} is known to {floor:.0e} only")
            }
            Self::Untestable { what, why } => write!(f, "{what} cannot be tested: {why}"),
            Self::BiasShown(bias) => write!(f, "biased-as-expected: {}", fine_percent(*bias)),
            Self::BiasNotShown(draws) => write!(f, "the bias is not shown after {draws} draws"),
            Self::NoBias { bias: 0.0, .. } => f.write_str("expected a bias, found none"),
            Self::NoBias { bias, ln_e, limit } => {
                let bias = fine_percent(*bias);
                write!(f, "expected a bias, found {bias} (ln E = {ln_e:.1} of {limit:.1})")
            }
            Self::BiasedElsewhere => f.write_str("biased elsewhere"),
            Self::NotFinite => f.write_str("draws are not finite numbers"),
            Self::DrawOff { what, off, largest, bound } => {
                let (most, bound) = (percent(*largest), percent(*bound));
                match off {
                    Some(mean) => write!(
                        f,
                        "{what} is off by {mean}; a draw by up to {most}, of which rounding explains {bound}"
                    ),
                    None => {
                        write!(f, "{what} is off by {most} in a draw; rounding explains {bound}")
                    }
                }
            }
            Self::LookupsOff(largest) => write!(
                f,
                "the number of lookups is off by {largest:.0} in a draw; theory has one number for all"
            ),
            Self::Cut { what, draws, fixed } => {
                write!(f, "{what}: cut after {draws} of {fixed} draws")
            }
            Self::TooFew(what) => write!(f, "{what} has too few draws for a test"),
            Self::Differs { what, p, details } if details.is_empty() => {
                write!(f, "{what} differs from theory: p = {p}")
            }
            Self::Differs { what, p, details } => {
                write!(f, "{what} differs from theory: p = {p} ({details})")
            }
            Self::VarianceAssumed => f.write_str("variance assumed"),
            Self::VarianceOpen => f.write_str("the mean relies on a variance that does not pass"),
            Self::RestsOnVariance(what) => {
                write!(f, "{what} rests on a variance that is refuted")
            }
            Self::SquaresByMean { about_truth, about_mean } => write!(
                f,
                "squares about the truth are too large by {}, for the mean is off; about the mean of the draws by {}",
                signed_percent(*about_truth),
                signed_percent(*about_mean)
            ),
            Self::Changes { from, to, off, z } => {
                write!(f, "the mean changes: from draw {from} ")?;
                match to {
                    None => f.write_str("on"),
                    Some(to) => write!(f, "to draw {to}"),
                }?;
                write!(f, " it is off by {off}, {z:+.1} standard errors from all other draws")
            }
            Self::Dependent(what) => write!(f, "the draws are not independent: {what}"),
            Self::NotJudged(what) => {
                write!(f, "{what} is not judged: the draws are not independent")
            }
            Self::Both(one, other) => write!(f, "{one}; {other}"),
        }
    }
}

impl Reason {
    fn unknown_spread(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self::UnknownSpread { what, ground, draws, carry, kurtosis, needed, tolerance } = self
        else {
            return Ok(());
        };
        let cure = cure(what);
        match (ground, kurtosis) {
            (None, _) => write!(
                f,
                "{what} is undecided after {draws} draws, too few to choose a tolerance by"
            )?,
            (Some(Ground::Kurtosis(kurtosis)), _) => write!(
                f,
                "the spread of {what} is not known: with a kurtosis of {kurtosis} it needs a first block of draws, \
                 {needed:.0} of them or more, and others after it; there are {draws}"
            )?,
            (_, Some([shown, assumed])) => write!(
                f,
                "the spread of {what} is not known: the draws show a kurtosis of {shown:.0}, more than the \
                 {assumed:.0} that was assumed; give {cure}"
            )?,
            (_, None) => write!(
                f,
                "the spread of {what} is not known: {carry} of {draws} draws carry it, and {EFFECTIVE} of more than \
                 {BLOCK} are needed; give {cure}"
            )?,
        }
        match tolerance {
            Some(asked) => write!(f, "; the tolerance of {asked:.1e} is not tested without that"),
            None => Ok(()),
        }
    }
}

/// A relative difference in percent with two decimals, or in powers of ten where it is small.
fn fine_percent(difference: f64) -> String {
    let percent = 100.0 * difference;
    if percent.abs() >= 0.01 { format!("{percent:+.2} %") } else { format!("{percent:+.1e} %") }
}

/// Words of a reason, or none: as files have them.
#[cfg(feature = "serde")]
pub(super) fn words<S: serde::Serializer>(
    reason: &Option<Reason>,
    to: S,
) -> Result<S::Ok, S::Error> {
    to.serialize_str(&reason.as_ref().map_or(String::new(), Reason::to_string))
}

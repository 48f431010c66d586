//! Theory of an experiment, and the tests of a draw's whole distribution.
//!
//! ```text
//! α    3/5 to the scalars, 1/5 to the drift, 1/5 to the distribution where it is tested; else 4/5 and 1/5
//! ```
//!
//! The tests themselves are those of a run. They and their looks need the library, and are therefore behind a trait here.

use std::fmt;
use std::panic::{RefUnwindSafe, UnwindSafe};
use std::sync::Arc;

use super::claim::{Claim, Options};
use super::judgement::DistributionFinding;
use super::scalar::SIDE_SHARE;

/// The channel that is a sum of those before it, by fixed weights: draws need not have it.
const DERIVED: &str = "luminance";

/// Input of the tests of a distribution.
#[derive(Debug, Clone, Copy)]
pub struct TestRequest {
    /// The level that the tests share.
    pub alpha: f64,
    /// Number of draws, where it is known and no decision ends them earlier.
    pub length: Option<u64>,
    /// True if draws come with their number of lookups.
    pub has_lookups: bool,
    /// The rounding of a draw, relative to its size.
    pub rounding: f64,
    /// Number of values of a draw.
    pub values: usize,
}

/// The distribution of a draw, as far as theory knows it.
pub trait Distribution: fmt::Debug + Send + Sync + UnwindSafe + RefUnwindSafe {
    /// The tests, before the first draw.
    ///
    /// # Errors
    ///
    /// The reason why nothing is tested, as a sentence.
    fn tests(&self, request: TestRequest) -> Result<Box<dyn Tests>, String>;
}

/// Tests of a distribution that take draws.
pub trait Tests: Send + Sync + UnwindSafe + RefUnwindSafe {
    /// Adds draws, a list for each value, and their lookups, if there are any.
    fn absorb(&mut self, columns: &[&[f64]], lookups: &[f64]);

    /// The findings, and the reasons why some tests were not made.
    fn close(self: Box<Self>) -> Tested;
}

/// The result of the tests of a distribution.
#[derive(Debug, Clone, Default)]
pub struct Tested {
    /// A finding for each test.
    pub findings: Vec<DistributionFinding>,
    /// Tests that were not made, with the reasons.
    pub untested: Vec<String>,
}

/// Input of a reading of draws beside its claim.
#[derive(Default)]
pub(super) struct Background {
    /// The experiment that the claim comes from, in words.
    pub(super) theory: Option<String>,
    /// The tests of the distribution.
    pub(super) tests: Option<Box<dyn Tests>>,
    /// What is not tested, in sentences.
    pub(super) notes: Vec<String>,
}

/// Theory of one experiment of a case: a claim for each channel, and the distribution of the draw.
#[derive(Debug, Clone)]
pub struct Theory {
    /// The claims with the names of their channels; the name is empty where there is one channel only.
    pub channels: Vec<(String, Claim)>,
    /// The experiment in words, with the swept value that was used.
    pub about: String,
    /// The tests of the whole distribution.
    pub distribution: Arc<dyn Distribution>,
}

impl Theory {
    /// Channels of draws of `values` values: all of them, or all but a luminance; `None` for other numbers.
    pub fn channels_of(&self, values: usize) -> Option<&[(String, Claim)]> {
        let all = &self.channels[..];
        match all.split_last() {
            _ if all.len() == values => Some(all),
            Some(((name, _), rest)) if name == DERIVED && rest.len() == values && values > 0 => {
                Some(rest)
            }
            _ => None,
        }
    }

    /// The numbers of values that draws may have, in words.
    pub fn widths(&self) -> String {
        let all = self.channels.len();
        match self.channels.last() {
            Some((name, _)) if name == DERIVED && all > 1 => {
                format!("{all} values, or {} without the {DERIVED}", all - 1)
            }
            _ => format!("{all} value{}", if all == 1 { "" } else { "s" }),
        }
    }

    /// The names of all channels.
    pub fn names(&self) -> Vec<String> {
        self.channels.iter().map(|(name, _)| name.clone()).collect()
    }
}

/// Theory for all properties that are not given by numbers.
#[derive(Debug, Clone, Copy)]
pub struct TheoryClaims<'a> {
    /// The theory.
    pub theory: &'a Theory,
    /// True if theory judges the lookups of the draws.
    pub has_lookups: bool,
    /// True if only the mean is taken from theory.
    pub is_mean_only: bool,
}

impl TheoryClaims<'_> {
    /// Background of the first of the readings of a draw's values: it tests the draw as a whole. `alpha` is the level of
    /// a value, `length` the number of draws, where it is known and no decision ends them earlier.
    pub(super) fn background(
        self,
        options: &Options,
        claims: &[Claim],
        length: Option<u64>,
    ) -> Background {
        let Self { theory, has_lookups, is_mean_only } = self;
        let mut background =
            Background { theory: Some(theory.about.clone()), ..Background::default() };
        let values = claims.len();
        if values < theory.channels.len() && values > 1 {
            let what = "is a sum of the channels, and not among the values of a draw";
            background.notes.push(format!("the {DERIVED} is not judged by itself: it {what}"));
        }
        let untested = |why: &str| format!("the distribution is not tested: {why}");
        if is_mean_only {
            background.notes.push(untested("of theory the mean alone is taken"));
        } else if options.batch > 1 {
            background.notes.push(untested("averages of draws have another one"));
        } else {
            let alpha = SIDE_SHARE * options.alpha;
            let rounding = claims.first().map_or(0.0, |claim| claim.rounding);
            let requested = TestRequest { alpha, length, has_lookups, rounding, values };
            match theory.distribution.tests(requested) {
                Ok(tests) => background.tests = Some(tests),
                Err(why) => background.notes.push(why),
            }
        }
        background
    }
}

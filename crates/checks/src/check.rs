//! Questions about draws, and the checks that answer them: they observe draws, merge blocks, look at the merged total,
//! and finish with a finding.
//!
//! ```text
//! observe  the draws of a block, buffer by buffer  → numbers of the block
//! merge    the numbers of blocks, in the order of their addresses  → a total
//! look     at the total at fixed numbers of blocks: may more draws change the result?
//! finish   the total  → a finding
//! ```
//!
//! Numbers and totals are plain data, so that files and other machines can hold them. Their meaning depends on the kind
//! of check: a quantity for the gate ([`super::scalar`]), a p-value ([`super::distribution`]), a bound on every draw
//! ([`super::always`]), an inspection of the streams ([`super::distribution::Inspection`]).

use gate::CheckId;
use serde::{Deserialize, Serialize};

use super::batch::Batch;
use super::distribution::{DistributionTest, Inspected};
use super::scalar::ScalarCheck;
use crate::Tolerance;
use gate::deviation::Deviation;
use gate::session::{Levels, Reason, Trail};
use gate::stats::verdict::{GateFinding, Verdict};
use numeric::sum::Sum;
use theory::{Channel, Moments, Prediction};

/// Input of a check before the first draw.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The prediction of theory.
    pub prediction: &'a Prediction,
    /// Number of draws that are planned.
    pub draws: u64,
    /// Largest number of draws that the plan may demand.
    pub maximum: u64,
    /// Number of the first draws that p-values see, whatever the gate decides.
    pub fixed: u64,
    /// Smallest differences that must be detected, as far as the case gives them.
    pub tolerance: Tolerance,
    /// True if the case declares the experiment biased.
    pub expect_biased: bool,
    /// True if an invariant holds for each draw, see [`estimators::Draw::defect`].
    pub has_invariant: bool,
    /// Spreads of pilot draws, channel by channel, where theory has none.
    pub pilots: Option<&'a [Pilot]>,
}

/// Spread of pilot draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pilot {
    /// `Σy²/n`, y the distance from their mean.
    pub variance: f64,
    /// `(Σy²)²/Σy⁴`: effective number of draws that contribute to the variance. The relative standard error of the
    /// variance is about one over its root.
    pub size: f64,
}

impl Pilot {
    /// Measures the spread of some draws.
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|x| (x - mean) * (x - mean));
        let sums = squares.fold([0.0; 2], |[two, four], y2| [two + y2, four + y2 * y2]);
        Self { variance: sums[0] / n, size: sums[0] * (sums[0] / sums[1]) }
    }
}

/// Question about the draws of an experiment.
pub struct Question {
    /// Its check.
    pub check: CheckId,
    /// Channel; `None` for the experiment as a whole.
    pub channel: Option<usize>,
    /// Name of its subject, as in `the mean`.
    pub what: String,
    /// The check that answers it.
    pub answer: Box<dyn Check>,
    /// True if the case declares a bias, which the answer must show.
    pub expects_bias: bool,
    /// Verdict if the draws are too few for the answer to pass reliably.
    pub too_weak: Verdict,
}

impl Question {
    /// Returns a question about the experiment as a whole.
    pub fn whole(check: CheckId, what: &str, answer: impl Check + 'static) -> Self {
        Self { channel: None, ..Self::channel(check, 0, what, Box::new(answer)) }
    }

    /// Returns a question about a distribution; none if there is no test.
    pub fn distribution(
        check: CheckId,
        what: &str,
        of: Option<impl DistributionTest + 'static>,
    ) -> Vec<Self> {
        of.into_iter().map(|one| Self::whole(check, what, one)).collect()
    }

    /// Returns a question about one channel.
    pub fn channel(check: CheckId, channel: usize, what: &str, answer: Box<dyn Check>) -> Self {
        Self {
            check,
            channel: Some(channel),
            what: what.to_owned(),
            answer,
            expects_bias: false,
            too_weak: Verdict::Underpowered,
        }
    }
}

/// Numbers of one check over all blocks.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Total {
    /// Sums over the blocks.
    pub sums: Vec<Sum>,
    /// Largest value of a draw, and the block where it was found first.
    pub largest: (f64, u64),
    /// Sums and looks of the gate.
    pub trail: Option<Trail>,
}

/// Number of draws at which a check looks.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// Number of draws so far.
    pub draws: u64,
    /// Number of draws that are planned.
    pub planned: u64,
    /// Levels of the gate.
    pub levels: Levels,
}

/// Place of a buffer of draws in its block.
#[derive(Debug, Clone, Copy)]
pub struct BufferPlace {
    /// Number of its first draw in the block.
    pub first: usize,
    /// True if p-values see its draws.
    pub is_fixed: bool,
}

/// Circumstances of the last look.
pub struct Context<'a> {
    /// Name of the quantity or distribution in sentences.
    pub what: &'a str,
    /// True if the case declares a bias that the check must show.
    pub expects_bias: bool,
    /// The number of draws, and the levels.
    pub look: Look,
    /// Number of draws that p-values see.
    pub fixed: u64,
    /// Verdict if the draws are too few for the check to pass reliably.
    pub too_weak: Verdict,
    /// Deviation of the mean of the channel.
    pub mean: Option<Deviation>,
    /// ln of the unit of the channel's mean, with a minus; 0 for plain units.
    pub log_unit: f64,
    /// The experiment and its streams.
    pub inspected: &'a Inspected<'a>,
}

/// Result of a check.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct CheckResult {
    /// p-value, which is judged together with all p-values of the run.
    pub p: Option<f64>,
    /// Numbers of the gate.
    pub gate: Option<GateFinding>,
    /// Number of draws and ln E at the looks of the gate, ascending: the last is the decision's. In a record, of more than
    /// 64 looks an even choice, ln E in steps of 0.001.
    #[serde(default, skip_serializing_if = "Vec::is_empty", with = "gate::extended")]
    pub path: Vec<[f64; 2]>,
    /// Block after which it was decided, or the block with the draw that fails.
    pub block: Option<u64>,
    /// The verdict.
    pub verdict: Verdict,
    /// The reason; `None` for a plain pass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<Reason>,
}

impl CheckResult {
    /// Returns a finding with a verdict and a reason alone.
    pub fn new(verdict: Verdict, reason: Option<Reason>) -> Self {
        Self { verdict, reason, p: None, gate: None, path: Vec::new(), block: None }
    }
}

/// Part of the error rate that a check uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ErrorShare {
    /// Four fifths, by e-Bonferroni.
    Gate,
    /// One fifth, by Holm.
    PValues,
    /// None: correct draws never fail it.
    Nothing,
}

/// Way to check draws.
pub trait Check: Send + Sync {
    /// Returns the part of the error rate that it uses.
    fn share(&self) -> ErrorShare {
        ErrorShare::Nothing
    }

    /// Returns the total before the first block.
    fn total(&self) -> Total {
        Total::default()
    }

    /// Returns an observer of the draws of a block.
    fn observe(&self) -> Box<dyn Observer + '_> {
        Box::new(Blind)
    }

    /// Adds the numbers of the next block to those of a block.
    fn join(&self, block: &mut [f64], next: &[f64]) {
        block.iter_mut().zip(next).for_each(|(sum, x)| *sum += x);
    }

    /// Adds the numbers of the next block to the total.
    fn merge(&self, total: &mut Total, block: &[f64], number: u64) {
        let _ = number;
        total.sums.iter_mut().zip(block).for_each(|(sum, &x)| sum.add(x));
    }

    /// Looks at the total. Returns whether more draws may change the result.
    fn look(&self, total: &mut Total, look: Look) -> bool {
        let _ = (total, look);
        false
    }

    /// Returns whether the total fails, whatever draws come later.
    fn has_failed(&self, total: &Total) -> bool {
        let _ = total;
        false
    }

    /// Returns the finding.
    fn finish(&self, total: &Total, context: &Context) -> CheckResult;

    /// Returns the reason why the plan allows no pass, and the number of draws that would; `None` if it allows one.
    fn too_weak(&self, what: &str) -> Option<(Reason, f64)> {
        let _ = what;
        None
    }

    /// Returns the quantity for the gate, if the check has one.
    fn scalar(&self) -> Option<&ScalarCheck> {
        None
    }

    /// Adds a bias to the quantity for the gate, in units of its tolerance, to test whether it is detected.
    fn shift(&mut self, tolerances: f64) {
        let _ = tolerances;
    }
}

/// Observer of a block: absorbs its draws, and returns its numbers.
pub trait Observer {
    /// Adds a buffer of draws; `y` is scratch space for the observed values.
    fn absorb(&mut self, draws: &Batch, place: BufferPlace, y: &mut Vec<f64>);

    /// Returns the numbers of the block, of which p-values see the first `fixed` draws.
    fn close(self: Box<Self>, fixed: usize) -> Vec<f64>;
}

/// Observer that ignores all draws.
struct Blind;

impl Observer for Blind {
    fn absorb(&mut self, _: &Batch, _: BufferPlace, _: &mut Vec<f64>) {}

    fn close(self: Box<Self>, _: usize) -> Vec<f64> {
        Vec::new()
    }
}

/// Check that cannot test anything, with the reason.
pub struct Untestable(pub String);

impl Check for Untestable {
    fn finish(&self, _: &Total, context: &Context) -> CheckResult {
        let reason = self.too_weak(context.what).map(|(reason, _)| reason);
        CheckResult::new(context.too_weak, reason)
    }

    fn too_weak(&self, what: &str) -> Option<(Reason, f64)> {
        let (what, why) = (what.to_owned().into(), self.0.clone());
        Some((Reason::Untestable { what, why }, f64::INFINITY))
    }
}

/// Relative error of a predicted variance beyond which the spread of draws cannot be compared with it.
pub const BLURRED: f64 = 1e-2;

/// Returns the last channel of an experiment and its moments, if these are known sharply enough to be compared with the
/// spread of draws; `None` otherwise.
pub fn last_channel<'a>(subject: &Subject<'a>) -> Option<(&'a Channel, Moments)> {
    let channel = subject.prediction.channels.last()?;
    let moments = channel.moments.filter(|moments| moments.error <= BLURRED)?;
    (!super::mean::is_faint(subject, channel)).then_some((channel, moments))
}

/// Returns the rounding error of a product of `lookups` factors, relative to the result.
pub fn rounding(lookups: f64) -> f64 {
    16.0 * f64::EPSILON * (1.0 + lookups)
}

/// Returns the rounding error of a draw of an experiment, by its expected lookups.
pub fn rounding_of(subject: &Subject) -> f64 {
    rounding(subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean))
}

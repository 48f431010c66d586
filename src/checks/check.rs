//! Questions about draws, and checks at work, which answer them: they observe draws, merge blocks, look at what is merged, and finish with a finding.
//!
//! ```text
//! observe  the draws of a block, buffer by buffer  → numbers of the block
//! merge    the numbers of blocks, in the order of their addresses  → a total
//! look     at the total at fixed numbers of blocks: may more draws change the result?
//! finish   the total  → a finding
//! ```
//!
//! Numbers and totals are plain data, so that files and other machines can hold them. Each kind of check owns their
//! meaning: a quantity for the gate ([`super::scalar`]), a p-value ([`super::law`]), a bound on every draw
//! ([`super::always`]), an inspection of the streams ([`super::law::Inspection`]).

use serde::{Deserialize, Serialize};

use super::batch::Batch;
use super::law::{Inspected, Law};
use super::scalar::Scalar;
use crate::case::Tolerance;
use ::gate::deviation::Deviation;
use ::gate::session::{Levels, Reason, Trail};
use ::gate::stats::verdict::{GateFinding, Verdict};
use numeric::sum::Sum;
use theory::{Channel, Moments, Prediction};

/// Knowledge of a check before the first draw.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The prediction of theory.
    pub prediction: &'a Prediction,
    /// Number of draws that are planned.
    pub draws: u64,
    /// Largest number of draws that the plan may ask for.
    pub most: u64,
    /// Number of the first draws that p-values see, whatever the gate decides.
    pub fixed: u64,
    /// The differences that matter, where the case says.
    pub tolerance: Tolerance,
    /// True if the case declares the experiment biased.
    pub expect_biased: bool,
    /// True if an invariant holds for each draw, see [`estimators::Draw::defect`].
    pub has_invariant: bool,
    /// Spreads of pilot draws, channel by channel, where theory has none.
    pub pilots: Option<&'a [Pilot]>,
}

/// The spread of pilot draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pilot {
    /// `Σy²/n`, y the distance from their mean.
    pub variance: f64,
    /// `(Σy²)²/Σy⁴`: how many draws made the variance; its own relative deviation is about one over the
    /// root of it.
    pub size: f64,
}

impl Pilot {
    /// Of some draws.
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|x| (x - mean) * (x - mean));
        let sums = squares.fold([0.0; 2], |[two, four], y2| [two + y2, four + y2 * y2]);
        Self { variance: sums[0] / n, size: sums[0] * (sums[0] / sums[1]) }
    }
}

/// One question.
pub struct Question {
    /// The name of the check that asks.
    pub check: String,
    /// The channel it is about; `None` for the experiment as a whole.
    pub channel: Option<usize>,
    /// Name of its subject, as in `the mean`.
    pub what: String,
    /// The check that answers it.
    pub answer: Box<dyn Check>,
    /// True if the case declares a bias, which the answer must show.
    pub expects_bias: bool,
    /// The verdict on an answer that was never promised to pass.
    pub too_weak: Verdict,
}

impl Question {
    /// A question about the experiment as a whole, without the name of its check.
    pub fn whole(what: &str, answer: impl Check + 'static) -> Self {
        Self { channel: None, ..Self::channel(0, what, Box::new(answer)) }
    }

    /// A question about a distribution, where there is one to test.
    pub fn law(what: &str, law: Option<impl Law + 'static>) -> Vec<Self> {
        law.into_iter().map(|law| Self::whole(what, law)).collect()
    }

    /// A question about one channel.
    pub fn channel(channel: usize, what: &str, answer: Box<dyn Check>) -> Self {
        Self {
            check: String::new(),
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

/// A number of draws at which a check looks.
#[derive(Debug, Clone, Copy)]
pub struct Look {
    /// Number of draws so far.
    pub draws: u64,
    /// Number of draws that are planned.
    pub planned: u64,
    /// Levels of the gate.
    pub levels: Levels,
}

/// Place of a buffer of draws.
#[derive(Debug, Clone, Copy)]
pub struct Place {
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
    /// The verdict on a check that was never promised to pass.
    pub too_weak: Verdict,
    /// Deviation of the mean of the channel.
    pub mean: Option<Deviation>,
    /// ln of the unit of the channel's mean, with a minus; 0 for plain units.
    pub log_unit: f64,
    /// The experiment and its streams.
    pub inspected: &'a Inspected<'a>,
}

/// Result of a check.
#[derive(Debug, Clone)]
pub struct Found {
    /// The verdict.
    pub verdict: Verdict,
    /// The reason; `None` for a plain pass.
    pub reason: Option<Reason>,
    /// The p-value, which the p-values of the run are judged with.
    pub p: Option<f64>,
    /// Numbers of the gate.
    pub gate: Option<GateFinding>,
    /// Number of draws and ln E at the looks of the gate.
    pub path: Vec<(u64, f64)>,
    /// The block that ends with the decision, or that has the draw that fails.
    pub block: Option<u64>,
}

impl Found {
    /// A verdict alone.
    pub fn new(verdict: Verdict, reason: Option<Reason>) -> Self {
        Self { verdict, reason, p: None, gate: None, path: Vec::new(), block: None }
    }
}

/// The share of the error rate that a check takes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Share {
    /// Four fifths, by e-Bonferroni.
    Gate,
    /// One fifth, by Holm.
    PValues,
    /// None: correct draws never fail it.
    Nothing,
}

/// A way to check draws.
pub trait Check: Send + Sync {
    /// The share of the error rate that it takes from.
    fn share(&self) -> Share {
        Share::Nothing
    }

    /// The total before the first block.
    fn total(&self) -> Total {
        Total::default()
    }

    /// An observer of the draws of a block.
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

    /// The finding.
    fn finish(&self, total: &Total, context: &Context) -> Found;

    /// Reason why the plan allows no pass, and the number of draws that do; `None` where it allows one.
    fn too_weak(&self, what: &str) -> Option<(Reason, f64)> {
        let _ = what;
        None
    }

    /// The quantity for the gate, if that is what the check asks for.
    fn scalar(&self) -> Option<&Scalar> {
        None
    }

    /// Adds a bias to the quantity for the gate, in units of its tolerance, to see whether it is found.
    fn shift(&mut self, tolerances: f64) {
        let _ = tolerances;
    }
}

/// Numbers of a block on their way.
pub trait Observer {
    /// Adds a buffer of draws; `y` is room for what is made of them.
    fn absorb(&mut self, draws: &Batch, place: Place, y: &mut Vec<f64>);

    /// The numbers of the block, of which p-values see the first `fixed` draws.
    fn close(self: Box<Self>, fixed: usize) -> Vec<f64>;
}

/// An observer of nothing.
struct Blind;

impl Observer for Blind {
    fn absorb(&mut self, _: &Batch, _: Place, _: &mut Vec<f64>) {}

    fn close(self: Box<Self>, _: usize) -> Vec<f64> {
        Vec::new()
    }
}

/// A check that tests nothing, and why.
pub struct Untestable(pub String);

impl Check for Untestable {
    fn finish(&self, _: &Total, context: &Context) -> Found {
        let reason = self.too_weak(context.what).map(|(reason, _)| reason);
        Found::new(context.too_weak, reason)
    }

    fn too_weak(&self, what: &str) -> Option<(Reason, f64)> {
        let (what, why) = (what.to_owned().into(), self.0.clone());
        Some((Reason::Untestable { what, why }, f64::INFINITY))
    }
}

/// Relative error of a variance beyond which the spread of draws cannot be compared with it.
pub const BLURRED: f64 = 1e-2;

/// The last channel of an experiment and its moments, where draws can be told from them: where these are
/// known, and rounding does not spoil what draws say of them.
pub fn last_channel<'a>(subject: &Subject<'a>) -> Option<(&'a Channel, Moments)> {
    let channel = subject.prediction.channels.last()?;
    let moments = channel.moments.filter(|moments| moments.error <= BLURRED)?;
    (!super::mean::is_faint(subject, channel)).then_some((channel, moments))
}

/// Rounding of a product of `lookups` factors, relative to the result.
pub fn rounding(lookups: f64) -> f64 {
    16.0 * f64::EPSILON * (1.0 + lookups)
}

/// Rounding of a draw of an experiment, by its expected lookups.
pub fn rounding_of(subject: &Subject) -> f64 {
    rounding(subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean))
}

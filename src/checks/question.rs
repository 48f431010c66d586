//! Questions about draws, and what a check knows when it asks them.

use std::panic::{RefUnwindSafe, UnwindSafe};

use super::batch::Batch;
use super::observe::Observe;
use crate::plan::options::Tolerance;
use ::gate::stats::gate::{self, Design};
use estimators::{DrawBuffer, Experiment};
use numeric::rng::Streams;
use theory::{Channel, Moments, Prediction};

/// What a check knows before the first draw.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// What theory says.
    pub prediction: &'a Prediction,
    /// How many draws are planned.
    pub draws: u64,
    /// How many draws the plan may ask for at most.
    pub most: u64,
    /// How many of the first draws the tests of laws get, whatever the gate decides.
    pub fixed: u64,
    /// The differences that matter, where the case says.
    pub tolerance: Tolerance,
    /// Whether the case declares the experiment biased.
    pub expect_biased: bool,
    /// Whether an invariant holds for each draw, see [`estimators::Draw::defect`].
    pub has_invariant: bool,
    /// Whether draws come one like the other; order-free ones come sorted by their lookups.
    pub is_in_turn: bool,
    /// What pilot draws say of spreads, channel by channel, where theory has none.
    pub pilots: Option<&'a [Pilot]>,
}

/// What pilot draws say of the spread of a draw.
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
    /// What it is about, as in `the mean`.
    pub what: String,
    /// How it is answered.
    pub kind: Kind,
    /// Whether the case declares a bias, which the answer must show.
    pub expects_bias: bool,
}

impl Question {
    /// A question about the experiment as a whole, without the name of its check.
    pub fn whole(what: &str, kind: Kind) -> Self {
        let (check, what) = (String::new(), what.to_owned());
        Self { check, channel: None, what, kind, expects_bias: false }
    }

    /// The same about a law, where there is one to test.
    pub fn law(what: &str, law: Option<impl Law + 'static>) -> Vec<Self> {
        law.into_iter().map(|law| Self::whole(what, Kind::Law(Box::new(law)))).collect()
    }

    /// The same about one channel.
    pub fn channel(channel: usize, what: &str, kind: Kind) -> Self {
        Self { channel: Some(channel), ..Self::whole(what, kind) }
    }
}

/// How a question is answered.
pub enum Kind {
    /// By the gate: a mean of 0 with a known variance.
    Scalar(Scalar),
    /// By a p-value over the first draws.
    Law(Box<dyn Law>),
    /// By every draw.
    Always(Always),
    /// By a p-value found by looking at the experiment and its streams afterwards.
    Inspection(Box<dyn Fn(&Inspected) -> f64 + Send + Sync>),
    /// Not at all: why not.
    Untestable(String),
}

/// A variance that is known worse than this, relative, is nothing to compare the spread of draws with.
pub const BLURRED: f64 = 1e-2;

/// A quantity y of each draw that has mean 0 and a known variance when all is well.
pub struct Scalar {
    /// y.
    pub observe: Observe,
    /// A number added to every y: 0, but where a bias is put in on purpose.
    pub bias: f64,
    /// What is asked of it.
    pub design: Design,
    /// How many draws the question is planned for.
    pub draws: f64,
    /// The least draws that are worth a promise: those that the widest ε worth it needs.
    pub least: f64,
    /// The draws that it would need to pass, where more than are planned: it may fail, but was
    /// never promised to pass.
    pub underpowered: Option<f64>,
    /// The quantity that y stands for, in theory: for messages.
    pub expected: f64,
    /// Size of y = 1 in units of the quantity.
    pub scale: f64,
}

/// What is known of a scalar.
#[derive(Debug, Clone, Copy)]
pub struct Known {
    /// Its variance in theory.
    pub variance: f64,
    /// The relative error bound of that.
    pub error: f64,
    /// What rounding and the prediction's own error may add to its mean.
    pub floor: f64,
}

/// What is wanted of a scalar.
#[derive(Debug, Clone, Copy)]
pub struct Wanted {
    /// ε as the case has it.
    pub tolerance: Option<f64>,
    /// The largest ε that is still worth a promise.
    pub cap: f64,
}

impl Scalar {
    /// Plans a question: ε from the case, or from the planned draws.
    pub fn new(subject: &Subject, known: Known, wanted: Wanted, observe: Observe) -> Self {
        let variance = known.variance * (1.0 + known.error);
        let draws = subject.draws as f64;
        let budget = gate::tolerance_of(variance, draws);
        let design = Design::new(variance, wanted.tolerance.unwrap_or(budget), known.floor);
        let widest = wanted.tolerance.unwrap_or(wanted.cap);
        let needs = |tolerance| gate::draws_of(variance, tolerance);
        // A question too fine for the prediction's own error never gets its promise.
        let blurred = design.tolerance > widest * (1.0 + 1e-9) && 4.0 * known.floor > widest;
        let underpowered = if blurred {
            Some(f64::INFINITY)
        } else {
            let needed = needs(design.tolerance.min(widest));
            (needed > draws * (1.0 + 1e-6)).then_some(needed)
        };
        let least = needs(Design::new(variance, widest, known.floor).tolerance);
        let draws = needs(design.tolerance);
        let (expected, scale) = (0.0, 1.0);
        Self { observe, bias: 0.0, design, draws, least, underpowered, expected, scale }
    }

    /// The question with its quantity: `expected` in theory, and `expected + scale y` where y is measured.
    #[must_use]
    pub fn of(self, expected: f64, scale: f64) -> Self {
        Self { expected, scale, ..self }
    }
}

/// A test of a whole law by sums over the first draws.
pub trait Law: Send + Sync + UnwindSafe + RefUnwindSafe {
    /// How many sums.
    fn size(&self) -> usize;

    /// Adds the draws of a buffer, of which the first is the block's draw number `first`, to the
    /// sums of the block.
    fn add(&self, draws: &Batch, first: usize, sums: &mut [f64]);

    /// Turns the sums of a block of `draws` draws into what is summed over blocks.
    fn close(&self, draws: usize, sums: &mut [f64]) {
        let _ = (draws, sums);
    }

    /// The p-value of the sums over `draws` draws; `None` where they test nothing.
    fn p_value(&self, sums: &[f64], draws: f64) -> Option<f64>;

    /// Details beside the p-value, in words; empty where there is nothing to add.
    fn details(&self, sums: &[f64], draws: f64) -> String {
        let _ = (sums, draws);
        String::new()
    }
}

/// An experiment with its streams, for checks that look for themselves.
pub struct Inspected<'a> {
    /// The experiment.
    pub experiment: &'a dyn Experiment,
    /// The channels of a draw.
    pub channels: usize,
    /// The streams of each block.
    pub streams: &'a dyn Fn(u64) -> Streams,
    /// How many blocks there are.
    pub blocks: u64,
}

impl Inspected<'_> {
    /// The first `count` values of the first block's draws, last channel.
    pub fn first_draws(&self, count: u64) -> Vec<f64> {
        let mut streams = (self.streams)(0);
        let mut buffer = DrawBuffer::new(self.channels);
        let (length, mut values) = (DrawBuffer::length(self.channels), Vec::new());
        while (values.len() as u64) < count {
            self.experiment.fill(&mut streams, length, &mut buffer);
            values.extend(buffer.values.iter().last().into_iter().flatten());
        }
        values
    }
}

/// A bound that every draw must keep.
pub struct Always {
    /// The largest value over a buffer; not a number where a draw is none.
    pub largest: Box<dyn Fn(&DrawBuffer) -> f64 + Send + Sync>,
    /// What it may not exceed.
    pub bound: f64,
}

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

/// The same for an experiment: by its expected lookups.
pub fn rounding_of(subject: &Subject) -> f64 {
    rounding(subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean))
}

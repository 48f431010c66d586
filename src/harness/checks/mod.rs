//! What is asked of the draws, one check per page.
//!
//! A check turns what theory says of an experiment into questions, all of them before the first
//! draw: the levels are then shared among all questions of the run. Questions are of four kinds.
//! Scalars go through the sequential gate and may stop the drawing; laws are tested by a p-value on
//! a number of draws fixed beforehand; what must hold for every draw is watched on every draw; and
//! the streams of random numbers are looked at themselves.

pub mod atoms;
pub mod counts;
pub mod covariance;
pub mod curve;
pub mod depth;
pub mod dispersion;
pub mod distances;
pub mod generator;
pub mod invariant;
pub mod lookups;
pub mod mean;
pub mod numeric;
pub mod resolution;
pub mod streams;
pub mod variance;

use super::case::Tolerance;
use super::counted::Counted;
use crate::catalogue::Catalogue;
use crate::estimators::{DrawBuffer, Experiment};
use crate::numeric::pack::in_fused_code;
use crate::rng::Streams;
use crate::stats::gate::{self, Design};
use crate::theory::Prediction;

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
    /// Whether each draw keeps its books, see [`crate::estimators::walk::Books`].
    pub keeps_books: bool,
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
    #[must_use]
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

/// Adds a y for each of the draws to the second argument.
pub type Observer<T> = Box<dyn Fn(&T, &mut Vec<f64>) + Send + Sync>;

/// How a y comes from a draw.
pub enum Observe {
    /// From the value of one channel.
    Value(usize, Observer<[f64]>),
    /// From the number of lookups.
    Lookups(Observer<[u32]>),
    /// From the draw as a whole.
    Draw(Observer<DrawBuffer>),
}

/// Appends `f` of each value, on the hardware's registers: `f` must be inlined.
fn observe_each(values: &[f64], y: &mut Vec<f64>, f: impl Fn(f64) -> f64) {
    // Not extended: that is compiled for the least machine.
    let first = y.len();
    y.resize(first + values.len(), 0.0);
    in_fused_code(
        #[inline(always)]
        || y[first..].iter_mut().zip(values).for_each(|(y, &x)| *y = f(x)),
    );
}

impl Observe {
    /// A y for each draw of a buffer.
    pub fn each(&self, draws: &DrawBuffer, y: &mut Vec<f64>) {
        match self {
            Self::Value(channel, observer) => observer(&draws.values[*channel], y),
            Self::Lookups(observer) => observer(&draws.lookups, y),
            Self::Draw(observer) => observer(draws, y),
        }
    }
}

/// A variance that is known worse than this, relative, is nothing to compare the spread of draws with.
const BLURRED: f64 = 1e-2;

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
    #[must_use]
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
        Self { observe, bias: 0.0, design, draws: needs(design.tolerance), least, underpowered }
    }
}

/// A test of a whole law by sums over the first draws.
pub trait Law: Send + Sync {
    /// How many sums.
    fn size(&self) -> usize;

    /// Adds the draws of a buffer, of which the first is the block's draw number `first`, to the
    /// sums of the block.
    fn add(&self, draws: &Counted, first: usize, sums: &mut [f64]);

    /// Turns the sums of a block of `draws` draws into what is summed over blocks.
    fn close(&self, draws: usize, sums: &mut [f64]) {
        let _ = (draws, sums);
    }

    /// The p-value of the sums over `draws` draws; `None` where they test nothing.
    fn p_value(&self, sums: &[f64], draws: f64) -> Option<f64>;
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
    #[must_use]
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

/// A page of the catalogue of checks.
pub trait Check: Sync {
    /// What it asks of an experiment; nothing where it does not apply.
    fn questions(&self, subject: &Subject) -> Vec<Ask>;

    /// Whether its p-values are uniform when all is well, or only never too often small.
    fn is_uniform(&self) -> bool {
        true
    }
}

/// A question without the name of its check.
pub struct Ask {
    /// See [`Question::channel`].
    pub channel: Option<usize>,
    /// See [`Question::what`].
    pub what: String,
    /// See [`Question::kind`].
    pub kind: Kind,
}

impl Ask {
    /// A question about the experiment as a whole.
    #[must_use]
    pub fn whole(what: &str, kind: Kind) -> Self {
        Self { channel: None, what: what.to_owned(), kind }
    }

    /// A question about one channel.
    #[must_use]
    pub fn channel(channel: usize, what: &str, kind: Kind) -> Self {
        Self { channel: Some(channel), what: what.to_owned(), kind }
    }
}

/// All questions of all checks, in the order of the catalogue.
#[must_use]
pub fn questions(subject: &Subject) -> Vec<Question> {
    let pages = CATALOGUE.pages.iter().zip(ALL);
    let asked = pages.flat_map(|(page, check)| {
        let check_name = page.name();
        check.questions(subject).into_iter().map(move |ask| {
            let Ask { channel, what, kind } = ask;
            let expects_bias = subject.expect_biased && check_name == "mean";
            Question { check: check_name.clone(), channel, what, kind, expects_bias }
        })
    });
    asked.collect()
}

/// See [`Check::is_uniform`].
#[must_use]
pub fn is_uniform(name: &str) -> bool {
    let named = CATALOGUE.pages.iter().zip(ALL).find(|(page, _)| page.name() == name);
    named.is_some_and(|(_, check)| check.is_uniform())
}

/// Lists the checks: from one line each come the module, the name and the row in `list`.
macro_rules! checks {
    ($($module:ident :: $Page:ident,)*) => {
        /// Every check, in the order of registration.
        pub const CATALOGUE: Catalogue =
            Catalogue { name: "checks", pages: &[$($crate::page!($module)),*] };

        /// The checks, in the order of the catalogue.
        const ALL: &[&dyn Check] = &[$(&$module::$Page),*];
    };
}

checks! {
    mean::Mean,
    variance::Variance,
    lookups::Lookups,
    covariance::Covariance,
    counts::Counts,
    atoms::Atoms,
    distances::Distances,
    depth::Depth,
    curve::Curve,
    dispersion::Dispersion,
    streams::Streams,
    generator::Generator,
    resolution::Resolution,
    invariant::Invariant,
    numeric::Numeric,
}

/// Rounding of a product of `lookups` factors, relative to the result.
#[must_use]
pub fn rounding(lookups: f64) -> f64 {
    16.0 * f64::EPSILON * (1.0 + lookups)
}

/// The same for an experiment: by its expected lookups.
#[must_use]
pub fn rounding_of(subject: &Subject) -> f64 {
    rounding(subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean))
}

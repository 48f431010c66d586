//! Tests of the whole distribution of foreign draws: the tests that a run makes of its own draws.
//!
//! ```text
//! distances   twenty classes of free flights and the share that leaves    checks::distances
//! depth       Anderson–Darling on the flights that collide                checks::depth
//! resolution  ties among the first 2¹⁴ flights                            checks::resolution
//! atoms       the shares of the values of draws that take few             checks::atoms
//! counts      the number of lookups                                       checks::counts
//! curve       the steps of one walk, where a draw has all its channels    checks::curve
//! covariance  consecutive channels of a draw                              checks::covariance
//! ```
//!
//! Foreign draws may be rounded. Values are matched within their rounding. Distances are not tested if the test would
//! notice how many of them rounding moves across the ends of classes. Resolutions of 22 bits or of single precision
//! count as fine; coarser ones fail, and finer ones are reported.

use gate::CheckId;
use std::borrow::Cow;
use std::sync::Arc;

use super::{Distribution, DistributionFinding, Reason, TestRequest, Tested, Tests};
use checks::batch::Batch;
use checks::resolution::{self, Resolution};
use checks::{self, DistributionTest};
use estimators::DrawBuffer;
use gate::stats::verdict::{BLOCK, Verdict};
use gate::stats::{multiplicity, ties};
use numeric::digits::short;
use theory::{self, Prediction};

/// Number of draws at the first look if the length is not known.
const FIRST: u64 = 1 << 11;
/// Relative error of a product in single precision.
const SINGLE_PRODUCT: f64 = 1e-5;
/// Error of a distance in single precision, relative to its position.
const SINGLE_POSITION: f64 = 1.2e-7;
/// Number of draws that covariances are tested for, and the largest, if the length is not known.
const COVARIANCE_DRAWS: u64 = 1 << 18;
const MAX_DRAWS: u64 = 1 << 24;
/// Largest shift of a class's share by rounding, in standard errors.
const HARMLESS: f64 = 0.05;

/// The distribution of an experiment's draw.
#[derive(Debug)]
pub struct Known(pub Arc<Prediction>);

impl Distribution for Known {
    fn tests(&self, asked: TestRequest) -> Result<Box<dyn Tests>, String> {
        let Prediction { distribution, increments, channels, .. } = &*self.0;
        let has_values = distribution.is_some() || !increments.is_empty();
        let is_known =
            (has_values && asked.values == channels.len()) || has_covariances(&self.0, asked);
        let has_counts = asked.has_lookups && checks::counts::of(&self.0).is_some();
        if let (false, false, Some(why)) = (is_known, has_counts, unknown(&self.0, asked)) {
            return Err(why);
        }
        let next = asked.length.unwrap_or(FIRST);
        Ok(Box::new(DistributionTests {
            prediction: Arc::clone(&self.0),
            asked,
            tests: None,
            fine: TieTest::of(&self.0),
            ties: Found::default(),
            untested: Vec::new(),
            seen: 0,
            next,
            looks: 0,
            buffer: DrawBuffer::new(asked.values),
        }))
    }
}

/// A test by sums over draws.
struct Test {
    check: CheckId,
    what: Cow<'static, str>,
    distribution: Box<dyn DistributionTest>,
    sums: Vec<f64>,
    /// Smallest and largest number of draws for which the test is valid.
    between: [f64; 2],
    found: Found,
}

impl Test {
    fn new(
        check: CheckId,
        what: impl Into<Cow<'static, str>>,
        distribution: impl DistributionTest + 'static,
        between: [f64; 2],
    ) -> Self {
        let (sums, found) = (vec![0.0; distribution.size()], Found::default());
        Self {
            check,
            what: what.into(),
            distribution: Box::new(distribution),
            sums,
            between,
            found,
        }
    }
}

/// Result of the last look, or of the look that refuted the distribution.
#[derive(Default)]
struct Found {
    p: Option<(f64, u64)>,
    is_refuted: bool,
    details: String,
}

/// All tests of a distribution.
struct DistributionTests {
    prediction: Arc<Prediction>,
    asked: TestRequest,
    /// Tests, made with the first draws, which show their precision.
    tests: Option<Vec<Test>>,
    fine: Option<TieTest>,
    /// Result of the test of ties.
    ties: Found,
    untested: Vec<String>,
    seen: u64,
    /// Number of draws at the next look.
    next: u64,
    looks: u32,
    buffer: DrawBuffer,
}

impl Tests for DistributionTests {
    fn absorb(&mut self, columns: &[&[f64]], lookups: &[f64]) {
        let Some(values) = columns.first() else { return };
        if self.tests.is_none() && !values.is_empty() {
            let is_single = columns.iter().all(|column| ties::all_single_precision(column));
            self.tests = Some(self.prepared(is_single));
        }
        let mut at = 0;
        while at < values.len() && self.seen < self.next {
            let room = usize::try_from(self.next - self.seen).unwrap_or(usize::MAX);
            let until = values.len().min(at.saturating_add(room));
            self.add(columns, lookups, at..until);
            self.seen += (until - at) as u64;
            at = until;
            if self.seen == self.next {
                self.look();
            }
        }
    }

    fn close(mut self: Box<Self>) -> Tested {
        let tests = self.tests.take().unwrap_or_default();
        let ties = std::mem::take(&mut self.ties);
        let fine = self.fine.take().map(|_| (CheckId::Resolution, Cow::Borrowed(RESOLUTION), ties));
        let n = self.seen as f64;
        let (rounded, tests): (Vec<_>, Vec<_>) =
            tests.into_iter().partition(|test| test.found.p.is_none() && n > test.between[1]);
        if !rounded.is_empty() {
            let what: Vec<Cow<str>> = rounded.into_iter().map(|test| test.what).collect();
            let why = "rounding of the draws moves as many of them as chance does";
            self.untested.push(format!("{} not tested: {why}", listed(&what)));
        }
        let all = tests.into_iter().map(|test| (test.check, test.what, test.found)).chain(fine);
        let (mut findings, mut few) = (Vec::new(), Vec::new());
        for (check, what, Found { p, is_refuted, details }) in all {
            let Some((p, draws)) = p else {
                few.push(what);
                continue;
            };
            let verdict = if is_refuted { Verdict::Fail } else { Verdict::Pass };
            let differs =
                || Reason::Differs { what: what.clone(), p: short(p, 2), details: details.clone() };
            let reason = is_refuted.then(differs);
            let what = what.into_owned();
            findings.push(DistributionFinding { check, what, verdict, reason, p, draws });
        }
        if !few.is_empty() {
            let why = match self.asked.length {
                Some(length) if self.seen < length => {
                    format!("{} of {length} announced draws came", self.seen)
                }
                _ => format!("{} draws are too few", self.seen),
            };
            self.untested.push(format!("{} not tested: {why}", listed(&few)));
        }
        if let Some(why) = unknown(&self.prediction, self.asked) {
            self.untested.push(why);
        }
        Tested { findings, untested: self.untested }
    }
}

/// Quantity of the test of ties.
const RESOLUTION: &str = "the resolution of the distances";

/// Joins names to a part of a sentence.
fn listed(things: &[Cow<str>]) -> String {
    match things {
        [one] => format!("{one} is"),
        [rest @ .., last] => format!("{} and {last} are", rest.join(", ")),
        [] => String::new(),
    }
}

impl DistributionTests {
    /// Returns the tests for draws of that precision.
    fn prepared(&mut self, is_single: bool) -> Vec<Test> {
        let prediction = Arc::clone(&self.prediction);
        let TestRequest { rounding, has_lookups, length, values, .. } = self.asked;
        let mut tests = Vec::new();
        let always = [0.0, f64::INFINITY];
        if let Some(counts) = checks::counts::of(&prediction).filter(|_| has_lookups) {
            tests.push(Test::new(
                CheckId::Counts,
                "the distribution of the lookups",
                counts,
                always,
            ));
        }
        let draws = length.unwrap_or(COVARIANCE_DRAWS);
        for (what, covariance) in checks::covariance::of(&prediction, draws, values) {
            tests.push(Test::new(CheckId::Covariance, what, covariance, always));
        }
        if values != prediction.channels.len() {
            return tests;
        }
        let product = if is_single { SINGLE_PRODUCT } else { 0.0 }.max(rounding);
        match checks::atoms::of(&prediction, product.max(checks::atoms::SAME)) {
            Ok(Some(atoms)) => {
                tests.push(Test::new(
                    CheckId::Atoms,
                    "the distribution of the values",
                    atoms,
                    always,
                ));
            }
            Ok(None) => {}
            Err(why) => {
                let what = "the distribution of the values is not tested";
                self.untested.push(format!("{what}: {why}"));
            }
        }
        let position = if is_single { SINGLE_POSITION } else { 0.0 }.max(rounding);
        let between = [0.0, most_draws(&prediction, position)];
        if let Some(classes) = checks::distances::of(&prediction) {
            let what = "the distribution of the distances";
            tests.push(Test::new(CheckId::Distances, what, classes, between));
        }
        if let Some(tails) = checks::depth::of(&prediction) {
            let what = "the distribution of the distances near both ends";
            tests.push(Test::new(CheckId::Depth, what, tails, between));
        }
        if let Some(least) = checks::curve::needed(&prediction) {
            let most = length.unwrap_or(MAX_DRAWS);
            let curve = checks::curve::of(&prediction, most, product.max(16.0 * f64::EPSILON));
            let what = "the distribution along the curve";
            tests.extend(
                curve.map(|steps| Test::new(CheckId::Curve, what, steps, [least, f64::INFINITY])),
            );
        }
        match &mut self.fine {
            Some(fine) if rounding <= COARSE => fine.is_single = is_single,
            _ => self.fine = None,
        }
        tests
    }

    /// Adds some of the draws.
    fn add(&mut self, columns: &[&[f64]], lookups: &[f64], range: std::ops::Range<usize>) {
        let Self { buffer, tests, fine, .. } = self;
        for (to, column) in buffer.values.iter_mut().zip(columns) {
            to.clear();
            to.extend_from_slice(&column[range.clone()]);
        }
        buffer.lookups.clear();
        if let Some(lookups) = lookups.get(range.clone()) {
            buffer.lookups.extend(lookups.iter().map(|&count| whole(count)));
        }
        if let (Some(fine), Some(column)) = (fine.as_mut(), columns.first()) {
            fine.absorb(&column[range]);
        }
        let draws = Batch::new(buffer);
        for test in tests.iter_mut().flatten() {
            test.distribution.add(&draws, 0, &mut test.sums);
        }
    }

    /// Looks at all p-values.
    fn look(&mut self) {
        let draws = self.seen;
        let n = draws as f64;
        let share = match self.asked.length {
            Some(_) => 1.0,
            None => 1.0 / (f64::from(self.looks + 1) * f64::from(self.looks + 2)),
        };
        let tests = self.tests.iter_mut().flatten();
        let mut all: Vec<(Option<f64>, &mut Found)> = Vec::new();
        for test in tests {
            let [least, most] = test.between;
            let p = test.distribution.p_value(&test.sums, n).filter(|_| least <= n && n <= most);
            if p.is_some() && !test.found.is_refuted {
                test.found.details = test.distribution.details(&test.sums, n);
            }
            all.push((p, &mut test.found));
        }
        if let Some(fine) = &mut self.fine {
            let found = if self.ties.is_refuted { None } else { fine.p_value() };
            let p = found.map(|(p, details)| {
                self.ties.details = details;
                p
            });
            all.push((p, &mut self.ties));
        }
        let p: Vec<f64> = all.iter().filter_map(|(p, _)| *p).collect();
        let rejected = multiplicity::holm(&p, all.len(), share * self.asked.alpha);
        let tested = all.into_iter().filter_map(|(p, found)| Some((p?, found)));
        for ((p, found), rejected) in tested.zip(rejected) {
            // A p-value of NaN comes from draws that are not finite, which are reported elsewhere.
            if !found.is_refuted {
                (found.p, found.is_refuted) = (Some((p, draws)), rejected);
            }
        }
        self.looks += 1;
        // With a known length, this was the only look.
        if self.asked.length.is_none() {
            self.next = self.next.saturating_mul(2);
        }
    }
}

/// Returns whether theory knows covariances of the values.
fn has_covariances(prediction: &Prediction, asked: TestRequest) -> bool {
    prediction.covariances.iter().any(|covariance| covariance.pair[1] < asked.values)
}

/// Returns a sentence about the part of the values' distribution that theory does not know.
fn unknown(prediction: &Prediction, asked: TestRequest) -> Option<String> {
    let Prediction { distribution, increments, channels, .. } = prediction;
    if asked.values != channels.len() && !increments.is_empty() {
        let why = "it takes all channels of a draw";
        return Some(format!("the distribution along the curve is not tested: {why}"));
    }
    if distribution.is_some() || !increments.is_empty() {
        return None;
    }
    let has_moments = channels.iter().any(|channel| channel.moments.is_some());
    let known = match (has_covariances(prediction, asked), has_moments) {
        (true, _) => "means, variances and covariances",
        (false, true) => "mean and variance",
        (false, false) => "the mean",
    };
    Some(format!("the distribution of the draws is not tested: theory knows {known} of it alone"))
}

/// Returns the largest number of distances that may be tested if they are rounded to `rounding`, relative to their
/// positions. Rounding moves no end of a class by more than a twentieth of its standard error. Infinite if theory has
/// no distances.
fn most_draws(prediction: &Prediction, rounding: f64) -> f64 {
    let Some(theory::Distribution::Distances { bins, from, .. }) = &prediction.distribution else {
        return f64::INFINITY;
    };
    let classes = (bins.len() + 1) as f64;
    let width = |k: usize| bins.get(k + 1).map_or(f64::INFINITY, |next| next - bins[k]);
    let most = |k: usize| {
        let below = (k + 1) as f64 / classes;
        let narrow = width(k).min(k.checked_sub(1).map_or(f64::INFINITY, width));
        let moved = rounding * (from.abs() + bins[k]) / (narrow * classes);
        HARMLESS * HARMLESS * below * (1.0 - below) / (moved * moved)
    };
    (0..bins.len()).map(most).fold(f64::INFINITY, f64::min)
}

/// Converts a number of lookups. NaN and negative numbers become 0; they are faults that are reported elsewhere.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
fn whole(count: f64) -> u32 {
    count.round() as u32
}

/// Spacing of numbers of single precision, relative.
const SINGLE: f64 = 2.4e-7;
/// Coarsest rounding of distances for which the resolution is tested.
const COARSE: f64 = 1e-6;
/// Number of bits of random numbers that counts as fine enough.
const BITS: i32 = 22;

/// First flights of another program: too many ties mean that distances are rounded more than to single precision.
struct TieTest {
    resolution: Resolution,
    first: Vec<f64>,
    /// True if they are numbers of single precision.
    is_single: bool,
}

impl TieTest {
    /// Starts before the first flight; `None` for draws that are not distances.
    fn of(prediction: &Prediction) -> Option<Self> {
        let resolution = Resolution::of(prediction)?;
        Some(Self { resolution, first: Vec::new(), is_single: true })
    }

    /// Adds flights, until there are enough.
    fn absorb(&mut self, flights: &[f64]) {
        let room = usize::try_from(BLOCK).unwrap_or(usize::MAX).saturating_sub(self.first.len());
        self.first.extend(flights.iter().take(room));
    }

    /// Returns the p-value of the number of ties, with details in words; `None` for too few collisions.
    fn p_value(&self) -> Option<(f64, String)> {
        let mut collisions = self.first.clone();
        self.resolution.collisions(&mut collisions);
        if collisions.len() < resolution::MIN_COLLISIONS {
            return None;
        }
        let spacing = if self.is_single { SINGLE } else { f64::EPSILON };
        let all = collisions.len();
        let expected = self.resolution.expected(all as f64, BITS, spacing);
        let found = ties::ties(&mut collisions);
        let details = format!(
            "{found} of {all} flights have the length of an earlier one, {expected:.0} at most are expected of single \
             precision"
        );
        Some((ties::p_value(found, expected), details))
    }
}

//! Tests of the whole distribution of foreign draws: those of [`checks`], with looks of their own.
//!
//! ```text
//! looks    once, after all draws, if their number is known before the first; else after 2¹¹, 2¹², 2¹³, … draws
//! level    of look j = 0, 1, …  α/((j + 1)(j + 2)), shared by all tests by Holm; of a single look α
//! ```
//!
//! No look depends on the draws.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use super::{Distribution, DistributionFinding, Reason, TestRequest, Tested, Tests};
use checks::batch::Batch;
use checks::{DistributionTest, ForeignDraws, ForeignTest};
use estimators::DrawBuffer;
use gate::CheckId;
use gate::stats::verdict::Verdict;
use gate::stats::{multiplicity, ties};
use numeric::digits::short;
use theory::Prediction;

/// Number of draws at the first look if the length is not known.
const FIRST: u64 = 1 << 11;

/// The distribution of an experiment's draw.
#[derive(Debug)]
pub struct KnownDistribution(pub Arc<Prediction>);

impl Distribution for KnownDistribution {
    fn tests(&self, request: TestRequest) -> Result<Box<dyn Tests>, String> {
        let Prediction { distribution, increments, channels, .. } = &*self.0;
        let has_values = distribution.is_some() || !increments.is_empty();
        let is_known =
            (has_values && request.values == channels.len()) || has_covariances(&self.0, request);
        let has_counts = request.has_lookups && checks::counts::is_known(&self.0);
        if let (false, false, Some(why)) = (is_known, has_counts, unknown(&self.0, request)) {
            return Err(why);
        }
        Ok(Box::new(DistributionTests {
            prediction: Arc::clone(&self.0),
            request,
            tests: None,
            untested: Vec::new(),
            seen: 0,
            next: request.length.unwrap_or(FIRST),
            looks: 0,
            buffer: DrawBuffer::new(request.values),
        }))
    }
}

/// A test with its sums over the draws.
struct Test {
    check: CheckId,
    what: Cow<'static, str>,
    distribution: Box<dyn DistributionTest>,
    /// Smallest and largest number of draws for which the test is valid.
    between: [f64; 2],
    sums: Vec<f64>,
    /// Finding of the last look, or of the look that refuted the distribution.
    finding: Option<DistributionFinding>,
}

impl Test {
    fn is_refuted(&self) -> bool {
        self.finding.as_ref().is_some_and(|finding| finding.verdict == Verdict::Fail)
    }

    /// Returns the p-value of n draws; `None` for too few draws or too many.
    fn p_value(&self, n: f64) -> Option<f64> {
        // Later draws do not change the ties among the first.
        if self.check == CheckId::Resolution && self.is_refuted() {
            return None;
        }
        let [minimum, maximum] = self.between;
        self.distribution.p_value(&self.sums, n).filter(|_| minimum <= n && n <= maximum)
    }

    /// Notes the p-value of a look, unless an earlier one has refuted the distribution.
    fn note(&mut self, p: f64, draws: u64, is_rejected: bool) {
        if self.is_refuted() {
            return;
        }
        let reason = is_rejected.then(|| Reason::Differs {
            what: self.what.clone(),
            p: short(p, 2),
            details: self.distribution.details(&self.sums, draws as f64),
        });
        let verdict = if is_rejected { Verdict::Fail } else { Verdict::Pass };
        let (check, what) = (self.check, self.what.clone().into_owned());
        self.finding = Some(DistributionFinding { check, what, verdict, reason, p, draws });
    }
}

/// All tests of a distribution.
struct DistributionTests {
    prediction: Arc<Prediction>,
    request: TestRequest,
    /// Tests, made with the first draws, which show their precision.
    tests: Option<Vec<Test>>,
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

    fn close(self: Box<Self>) -> Tested {
        let Self { prediction, request, tests, mut untested, seen, .. } = *self;
        let (mut findings, mut rounded, mut few) = (Vec::new(), Vec::new(), Vec::new());
        for Test { what, between, finding, .. } in tests.unwrap_or_default() {
            match finding {
                Some(finding) => findings.push(finding),
                None if seen as f64 > between[1] => rounded.push(what),
                None => few.push(what),
            }
        }
        if !rounded.is_empty() {
            let why = "rounding of the draws moves as many of them as chance does";
            untested.push(format!("{} not tested: {why}", listed(&rounded)));
        }
        if !few.is_empty() {
            let why = match request.length {
                Some(length) if seen < length => format!("{seen} of {length} announced draws came"),
                _ => format!("{seen} draws are too few"),
            };
            untested.push(format!("{} not tested: {why}", listed(&few)));
        }
        untested.extend(unknown(&prediction, request));
        Tested { findings, untested }
    }
}

/// Joins names to a part of a sentence.
fn listed(things: &[Cow<str>]) -> String {
    match things {
        [one] => format!("{one} is"),
        [rest @ .., last] => format!("{} and {last} are", rest.join(", ")),
        [] => String::new(),
    }
}

impl DistributionTests {
    /// Returns the tests for draws of that precision, those of lookups first.
    fn prepared(&mut self, is_single: bool) -> Vec<Test> {
        let (prediction, request) = (&self.prediction, self.request);
        let mut foreign = checks::of_foreign(&ForeignDraws { prediction, request, is_single });
        foreign.sort_by_key(|(check, _)| *check != CheckId::Counts);
        let mut tests = Vec::new();
        for (check, ForeignTest { what, test, between }) in foreign {
            match test {
                Ok(distribution) => {
                    let (sums, finding) = (vec![0.0; distribution.size()], None);
                    tests.push(Test { check, what, distribution, between, sums, finding });
                }
                Err(why) => self.untested.push(format!("{what} is not tested: {why}")),
            }
        }
        tests
    }

    /// Adds some of the draws.
    fn add(&mut self, columns: &[&[f64]], lookups: &[f64], range: Range<usize>) {
        let Self { buffer, tests, .. } = self;
        for (to, column) in buffer.values.iter_mut().zip(columns) {
            to.clear();
            to.extend_from_slice(&column[range.clone()]);
        }
        buffer.lookups.clear();
        if let Some(lookups) = lookups.get(range) {
            buffer.lookups.extend(lookups.iter().map(|&count| whole(count)));
        }
        let draws = Batch::new(buffer);
        for test in tests.iter_mut().flatten() {
            test.distribution.add(&draws, 0, &mut test.sums);
        }
    }

    /// Looks at all p-values.
    fn look(&mut self) {
        let draws = self.seen;
        let share = match self.request.length {
            Some(_) => 1.0,
            None => 1.0 / (f64::from(self.looks + 1) * f64::from(self.looks + 2)),
        };
        let tests = self.tests.as_deref_mut().unwrap_or_default();
        let p: Vec<Option<f64>> = tests.iter().map(|test| test.p_value(draws as f64)).collect();
        let rejected = multiplicity::holm(&p, p.len(), share * self.request.alpha);
        for ((test, p), is_rejected) in tests.iter_mut().zip(p).zip(rejected) {
            // A p-value of NaN comes from draws that are not finite, which are reported elsewhere.
            if let Some(p) = p {
                test.note(p, draws, is_rejected);
            }
        }
        self.looks += 1;
        // With a known length, this was the only look.
        if self.request.length.is_none() {
            self.next = self.next.saturating_mul(2);
        }
    }
}

/// Returns whether theory knows covariances of the values.
fn has_covariances(prediction: &Prediction, request: TestRequest) -> bool {
    prediction.covariances.iter().any(|covariance| covariance.pair[1] < request.values)
}

/// Returns a sentence about the part of the values' distribution that theory does not know.
fn unknown(prediction: &Prediction, request: TestRequest) -> Option<String> {
    let Prediction { distribution, increments, channels, .. } = prediction;
    if request.values != channels.len() && !increments.is_empty() {
        let why = "it takes all channels of a draw";
        return Some(format!("the distribution along the curve is not tested: {why}"));
    }
    if distribution.is_some() || !increments.is_empty() {
        return None;
    }
    let has_moments = channels.iter().any(|channel| channel.moments.is_some());
    let known = match (has_covariances(prediction, request), has_moments) {
        (true, _) => "means, variances and covariances",
        (false, true) => "mean and variance",
        (false, false) => "the mean",
    };
    Some(format!("the distribution of the draws is not tested: theory knows {known} of it alone"))
}

/// Converts a number of lookups. NaN and negative numbers become 0; they are faults that are reported elsewhere.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
fn whole(count: f64) -> u32 {
    count.round() as u32
}

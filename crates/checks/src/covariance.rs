//! The covariance of consecutive distances of one walk against theory, by the gate.
//!
//! ```text
//! y = ((X₁ − T₁)(X₂ − T₂) − C)/(sd₁ sd₂),  C = T₁T₂ expm1(J₂(s₁)),  Var[y] in theory
//! ```
//!
//! It applies to problems with several channels, and is reported with the farther one. Consecutive channels are enough:
//! increments over disjoint stretches are uncorrelated, so these covariances determine all others.

use gate::CheckId;
use std::panic::AssertUnwindSafe;

use super::batch::{Batch, Observe};
use super::check::{Check, Question, Subject, Untestable};
use super::distribution::DistributionTest;
use super::foreign::{ANY, ForeignDraws, ForeignTest};
use super::mean::is_faint;
use super::scalar::{ScalarCheck, variance};
use crate::{CheckKind, Tolerance};
use estimators::DrawBuffer;
use gate::session::Quantity;
use gate::stats::gate::GateSums;
use theory::prediction::Covariance as Predicted;

/// Largest error of a covariance for which a pass is still promised, relative to the product of the standard
/// deviations.
const CAP: f64 = 0.2;
/// Relative error of a predicted covariance.
const ERROR: f64 = 1e-10;
/// Number of foreign draws that covariances are tested for, if it is not known.
const FOREIGN: u64 = 1 << 18;

/// Covariance as a test with a p-value: `min(1, 1/E)`, E the gate's e-value after a number of draws that is fixed
/// beforehand. `P(E ≥ 1/p) ≤ p` by Markov's inequality.
struct ByGate(AssertUnwindSafe<ScalarCheck>);

impl DistributionTest for ByGate {
    fn size(&self) -> usize {
        GateSums::default().totals().len()
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        let arguments = self.0.planned.design.arguments();
        let mut finding = GateSums::default();
        draws.observe(&self.0.observe, &mut Vec::new(), |y, _| finding.absorb(y, &arguments));
        sums.iter_mut().zip(finding.totals()).for_each(|(sum, x)| *sum += x);
    }

    fn p_value(&self, sums: &[f64], draws: f64) -> Option<f64> {
        let sums = sums.try_into().ok()?;
        Some((-self.0.planned.design.evidence(sums, draws).ln_e).exp().min(1.0))
    }
}

/// Returns the tests of foreign draws.
fn of_foreign(foreign: &ForeignDraws) -> Vec<ForeignTest> {
    let (prediction, request) = (foreign.prediction, foreign.request);
    let draws = request.length.unwrap_or(FOREIGN);
    let subject = Subject {
        prediction,
        draws,
        maximum: draws,
        fixed: draws,
        tolerance: Tolerance::default(),
        expect_biased: false,
        has_invariant: false,
        pilots: None,
    };
    let requested = scalars(&subject).filter(|requested| requested.channel < request.values);
    let tests = requested.filter_map(|CovarianceRequest { channel, what, scalar }| {
        let what = format!("{what} of {}", prediction.channels[channel].name).into();
        let test = Ok(Box::new(ByGate(AssertUnwindSafe(scalar?))) as Box<dyn DistributionTest>);
        Some(ForeignTest { what, test, between: ANY })
    });
    tests.collect()
}

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Covariance, questions).of_foreign(of_foreign);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let questions = scalars(subject).map(|CovarianceRequest { channel, what, scalar }| {
        let answer: Box<dyn Check> = match scalar {
            Some(scalar) => Box::new(scalar),
            None => Box::new(Untestable("its variance overflows".into())),
        };
        Question::channel(CheckId::Covariance, channel, &what, answer)
    });
    questions.collect()
}

/// Covariance of a channel with the one before it; no scalar if its variance overflows.
struct CovarianceRequest {
    channel: usize,
    what: String,
    scalar: Option<ScalarCheck>,
}

fn scalars<'a>(subject: &'a Subject) -> impl Iterator<Item = CovarianceRequest> + 'a {
    let covariances = subject.prediction.covariances.iter();
    covariances
        .filter(|covariance| covariance.pair[0] + 1 == covariance.pair[1])
        .filter_map(|covariance| ask(subject, covariance))
}

fn ask(subject: &Subject, covariance: &Predicted) -> Option<CovarianceRequest> {
    let [first, second] = covariance.pair.map(|i| &subject.prediction.channels[i]);
    if is_faint(subject, first) || is_faint(subject, second) {
        return None;
    }
    let scale = [first, second].map(|channel| {
        let variance = channel.moments.map_or(0.0, |moments| moments.variance());
        1.0 / variance.sqrt()
    });
    let what = format!("the covariance with {}", first.name);
    let unit = scale[0] * scale[1];
    let known = covariance.variance * unit * unit;
    let scalar = (known.is_finite() && known > 0.0).then(|| {
        let quantity =
            Quantity::new(CheckId::Covariance, what.clone(), variance(known, ERROR), ERROR, CAP);
        let ([i, j], truth) = (covariance.pair, [first.mean.value, second.mean.value]);
        let expected = covariance.value * unit;
        let observe =
            move |draws: &DrawBuffer, y: &mut Vec<f64>| {
                let both = draws.values[i].iter().zip(&draws.values[j]);
                y.extend(both.map(|(a, b)| {
                    (a - truth[0]) * scale[0] * ((b - truth[1]) * scale[1]) - expected
                }));
            };
        let observe = Observe::Draw(Box::new(observe));
        ScalarCheck::new(subject, quantity.of(covariance.value, 1.0 / unit), observe)
    });
    Some(CovarianceRequest { channel: covariance.pair[1], what, scalar })
}

//! The whole curve of one walk: the mean of `T̂(s)/T(s) − 1` as a process in s.
//!
//! ```text
//! R(s) = mean of X(s)/T(s) − 1 is a martingale with the clock g(s) = expm1(J₂(s))
//! Σ_j n (ΔR_j)²/Δg_j is χ²;   √n max|R|/√g(S) has P(D > x) ≤ 4 Σ (−1)^k Φ̄((2k + 1)x)
//! ```
//!
//! It detects a walk that goes wrong on the way and is right at the end. Both limits need `n ≥ 100 κ`, κ the kurtosis
//! of an increment, and ten times the rare-event size; below that each increment goes through the gate instead.
//!
//! Source: the martingale is Eq. 13 of Szirmay-Kalos et al. 2017, in which increments over disjoint stretches are
//! independent. The supremum is the reflection principle of Brownian motion.

use super::batch::{Batch, Observe};
use super::check::{Question, Subject, rounding, rounding_of};
use super::distribution::DistributionTest;
use super::foreign::{ForeignDraws, ForeignTest};
use super::scalar::{ScalarCheck, variance};
use crate::CheckKind;
use estimators::DrawBuffer;
use gate::CheckId;
use gate::session::Quantity;
use gate::session::quantity::MEAN_CAP;
use gate::stats::{chi_square, normal};
use numeric::sum::{sum_in_lanes, sum_of_pairs};
use theory::{Increment, Prediction};

/// Largest relative error of a step's variance for the asymptotic tests.
const SHARP: f64 = 1e-3;
/// Largest number of foreign draws, if it is not known.
const FOREIGN: u64 = 1 << 24;

/// Increments `X_j/T_j − X_{j−1}/T_{j−1}`, some of them joined.
struct Increments {
    /// Channel j at the end of each.
    at: Vec<usize>,
    /// `1/T_j`.
    scale: Vec<f64>,
    /// `Δg_j`.
    clock: Vec<f64>,
}

impl Increments {
    /// Joins an increment to the next if rounding in `draws` draws could spoil it: a step counts if `Δg > n (10³ δ)²`.
    /// `None` if there is no such step.
    fn of(prediction: &Prediction, draws: u64, rounding: f64) -> Option<Self> {
        let minimum = draws as f64 * (1e3 * rounding).powi(2);
        let scale = scale(prediction);
        let mut joined = Self { at: Vec::new(), scale: Vec::new(), clock: Vec::new() };
        let mut clock = 0.0;
        for (j, increment) in prediction.increments.iter().enumerate() {
            clock += increment.variance;
            if clock > minimum {
                joined.at.push(j);
                joined.scale.push(scale[j]);
                joined.clock.push(std::mem::take(&mut clock));
            }
        }
        (!joined.at.is_empty()).then_some(joined)
    }
}

impl DistributionTest for Increments {
    fn size(&self) -> usize {
        self.scale.len()
    }

    fn add(&self, draws: &Batch, _: usize, sums: &mut [f64]) {
        let mut last: Option<(&[f64], f64)> = None;
        for ((&j, &scale), sum) in self.at.iter().zip(&self.scale).zip(sums) {
            let now = &draws.draws.values[j];
            *sum += match last {
                None => sum_in_lanes(now, |x| x * scale - 1.0),
                Some((before, unit)) => {
                    sum_of_pairs(now, before, |now, before| now * scale - before * unit)
                }
            };
            last = Some((now, scale));
        }
    }

    fn p_value(&self, sums: &[f64], draws: f64) -> Option<f64> {
        let (mut square, degrees) = (0.0, self.clock.len() as f64);
        let (mut path, mut furthest, mut clock) = (0.0, 0.0f64, 0.0);
        for (&sum, &step) in sums.iter().zip(&self.clock) {
            square += sum * sum / (draws * step);
            path += sum;
            furthest = furthest.max(f64::abs(path));
            clock += step;
        }
        let supremum = normal::excursion_tail(furthest / (draws * clock).sqrt());
        // Twice the smaller p-value: two tests of the same draws.
        Some((2.0 * chi_square::upper(square, degrees).min(supremum)).min(1.0))
    }
}

/// Returns the smallest number of draws for which the limits hold; `None` where theory has no steps, or their variances
/// are too uncertain.
fn needed(prediction: &Prediction) -> Option<f64> {
    let increments = &prediction.increments;
    let kurtosis = increments.iter().fold(0.0f64, |maximum, step| maximum.max(step.kurtosis));
    let tails = prediction.channels.iter().map(|channel| channel.tails.rare_event_size);
    let rare = tails.fold(0.0f64, f64::max);
    let is_sharp = !increments.is_empty() && increments.iter().all(|step| step.error <= SHARP);
    is_sharp.then(|| (100.0 * kurtosis).max(10.0 * rare))
}

/// Returns the tests of foreign draws.
fn of_foreign(draws: &ForeignDraws) -> Vec<ForeignTest> {
    let Some(prediction) = draws.in_full() else { return Vec::new() };
    let Some(minimum) = needed(prediction) else { return Vec::new() };
    let maximum = draws.request.length.unwrap_or(FOREIGN);
    let steps = Increments::of(prediction, maximum, draws.error_of_product().max(rounding(0.0)));
    ForeignTest::of("the distribution along the curve", steps, [minimum, f64::INFINITY])
}

/// Returns `1/T_j`.
fn scale(prediction: &Prediction) -> Vec<f64> {
    prediction.channels.iter().map(|channel| 1.0 / channel.truth.value).collect()
}

/// The check.
pub const CHECK: CheckKind =
    CheckKind::new(CheckId::Curve, questions).not_uniform().of_foreign(of_foreign);

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    let increments = &subject.prediction.increments;
    if increments.is_empty() {
        return Vec::new();
    }
    let is_long = needed(subject.prediction).is_some_and(|minimum| subject.fixed as f64 >= minimum);
    if is_long {
        let rounding = rounding_of(subject);
        let increments = Increments::of(subject.prediction, subject.fixed, rounding);
        return Question::distribution(CheckId::Curve, "the curve along one walk", increments);
    }
    let scale = scale(subject.prediction);
    let has_spread = |increment: &Increment| {
        increment.variance > 0.0 && (increment.variance * (1.0 + increment.error)).is_finite()
    };
    let steps = increments.iter().enumerate().filter(|(_, increment)| has_spread(increment));
    steps
        .map(|(j, increment)| {
            let step = step(subject, j, &scale, increment);
            Question::channel(CheckId::Curve, j, STEP, Box::new(step))
        })
        .collect()
}

/// Name of an increment in sentences.
const STEP: &str = "the step to it";

fn step(subject: &Subject, j: usize, scale: &[f64], increment: &Increment) -> ScalarCheck {
    let (here, before) = (scale[j], j.checked_sub(1).map(|i| (i, scale[i])));
    let observe = move |draws: &DrawBuffer, y: &mut Vec<f64>| {
        y.extend((0..draws.lookups.len()).map(|draw| {
            let last = before.map_or(1.0, |(i, scale)| draws.values[i][draw] * scale);
            draws.values[j][draw] * here - last
        }));
    };
    // A bias of an increment counts as much as one of the mean.
    let ground = variance(increment.variance, increment.error);
    let step = Quantity::new(CheckId::Curve, STEP, ground, rounding_of(subject), MEAN_CAP);
    let step = step.within(subject.tolerance.mean);
    ScalarCheck::new(subject, step, Observe::Draw(Box::new(observe)))
}

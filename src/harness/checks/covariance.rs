//! The covariance of every two distances of one walk against theory.
//!
//! ```text
//! z = (c − C)/√(Var[(X₁ − T₁)(X₂ − T₂)]/n),  C = T₁T₂ expm1(J₂(s₁))
//! ```
//!
//! It applies to problems with several channels, and is reported with the farther one.

use super::{Check, Comparison, Evidence, Kind, Limits, Statistic, Subject};
use crate::estimators::DrawBuffer;
use crate::harness::record::Finding;
use crate::theory;

/// The largest error of a covariance, relative to the product of the standard deviations.
const TOLERANCE: f64 = 0.2;

/// The check of the covariances.
pub struct Covariance;

struct Products {
    pairs: Vec<[usize; 2]>,
    truth: Vec<f64>,
}

impl Statistic for Products {
    fn size(&self) -> usize {
        self.pairs.len()
    }

    fn add(&self, draws: &DrawBuffer, sums: &mut [f64]) {
        for (&[i, j], sum) in self.pairs.iter().zip(sums) {
            let both = draws.values[i].iter().zip(&draws.values[j]);
            *sum += both
                .map(|(a, b)| (a / self.truth[i] - 1.0) * (b / self.truth[j] - 1.0))
                .sum::<f64>();
        }
    }
}

/// The covariances whose channels have a spread beyond rounding.
fn testable<'a>(
    subject: &Subject<'a>,
) -> impl Iterator<Item = &'a theory::prediction::Covariance> + use<'a> {
    let channels = &subject.prediction.channels;
    subject.prediction.covariances.iter().filter(move |covariance| {
        covariance.variance > 0.0
            && covariance.variance.is_finite()
            && covariance
                .pair
                .iter()
                .all(|&i| channels[i].moments.is_some_and(|moments| moments.relative[0] > 1e-20))
    })
}

impl Check for Covariance {
    fn kind(&self) -> Kind {
        Kind::Scalar
    }

    fn hypotheses(&self, subject: &Subject) -> usize {
        testable(subject).count()
    }

    fn statistic(&self, subject: &Subject) -> Option<Box<dyn Statistic>> {
        let pairs: Vec<[usize; 2]> = testable(subject).map(|covariance| covariance.pair).collect();
        let truth = subject.prediction.channels.iter().map(|channel| channel.truth.value).collect();
        (!pairs.is_empty()).then(|| Box::new(Products { pairs, truth }) as Box<dyn Statistic>)
    }

    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding> {
        let channels = &subject.prediction.channels;
        let draws = evidence.tallies[0].draws as f64;
        let pairs = testable(subject).zip(evidence.sums);
        pairs
            .map(|(covariance, sum)| {
                let [i, j] = covariance.pair;
                let unit = channels[i].truth.value * channels[j].truth.value;
                let spread = |k: usize| channels[k].moments.map_or(0.0, |m| m.relative[0].sqrt());
                let kurtosis = |k: usize| {
                    channels[k].moments.and_then(|m| m.kurtosis()).unwrap_or(f64::INFINITY)
                };
                let tail = channels[j].tails.eighth_moment_ratio;
                let comparison = Comparison {
                    difference: sum.value() / draws - covariance.value / unit,
                    standard_error: (covariance.variance / draws).sqrt() / unit,
                    allowance: 1e-10 * spread(i) * spread(j),
                    tolerance: TOLERANCE * spread(i) * spread(j),
                    draws_for_level: 100.0 * kurtosis(i).max(kurtosis(j)).max(tail),
                };
                let what = format!("the covariance with {}", channels[i].name);
                let (verdict, reason) = comparison.verdict(&what, subject, limits);
                let (check, channel) = ("covariance".into(), channels[j].name.clone());
                Finding { check, channel, z: Some(comparison.z()), p: None, verdict, reason }
            })
            .collect()
    }
}

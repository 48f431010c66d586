//! The number of lookups against its Poisson law, by Pearson's χ².
//!
//! It applies where nothing ends a walk early: then the number of tentative collisions is Poisson
//! with mean ∫σ̂ exactly.

use super::{Check, Evidence, Kind, Limits, Statistic, Subject, law_finding};
use crate::estimators::DrawBuffer;
use crate::harness::record::Finding;
use crate::stats::chi_square;
use crate::theory::count::poisson;

/// The check of the Poisson law.
pub struct Poisson;

struct Counts(usize);

impl Statistic for Counts {
    fn size(&self) -> usize {
        self.0 + 1
    }

    fn add(&self, draws: &DrawBuffer, sums: &mut [f64]) {
        for &lookups in &draws.lookups {
            sums[(lookups as usize).min(self.0)] += 1.0;
        }
    }
}

fn probabilities(subject: &Subject) -> Option<Vec<f64>> {
    let law = subject.prediction.lookups.as_ref().filter(|law| law.poisson && law.mean > 0.0)?;
    let most = law.mean + 10.0 * law.mean.sqrt() + 20.0;
    let probability: Vec<f64> =
        (0..u32::MAX).take_while(|&n| f64::from(n) <= most).map(|n| poisson(n, law.mean)).collect();
    let enough = chi_square::testable_bins(&probability, subject.draws as f64) > 1;
    enough.then_some(probability)
}

impl Check for Poisson {
    fn kind(&self) -> Kind {
        Kind::Law
    }

    fn hypotheses(&self, subject: &Subject) -> usize {
        usize::from(probabilities(subject).is_some())
    }

    fn statistic(&self, subject: &Subject) -> Option<Box<dyn Statistic>> {
        let probability = probabilities(subject)?;
        Some(Box::new(Counts(probability.len())))
    }

    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding> {
        let Some(probability) = probabilities(subject) else { return Vec::new() };
        let p = chi_square::p_value(evidence.sums, &probability);
        let what = "the lookups are not Poisson";
        law_finding("poisson", what, p, limits).into_iter().collect()
    }
}

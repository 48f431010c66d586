//! A draw with few possible values: each value's share against its probability, by Pearson's χ².
//!
//! It applies where theory knows all values: 0 and 1 of tracking estimators, the powers
//! `T_c (1 − r)^N` of a constant ratio, the single value of deterministic estimators. A draw that
//! is none of them counts as strange, and more than a handful of those fail the check.

use super::{Check, Evidence, Kind, Limits, Statistic, Subject, law_finding};
use crate::estimators::DrawBuffer;
use crate::harness::record::{Finding, Verdict};
use crate::stats::chi_square;
use crate::theory::Law;

/// A draw this near to a value, relative to the value's size, is that value.
const SAME: f64 = 1e-9;

/// The check of the atoms.
pub struct Atoms;

/// The values in ascending order with their probabilities, and where each came from.
struct Values {
    value: Vec<f64>,
}

impl Values {
    /// The nearest atom, if it is near enough.
    fn find(&self, x: f64) -> Option<usize> {
        let after = self.value.partition_point(|&value| value < x);
        let near = |i: &usize| {
            let value = self.value[*i];
            (x - value).abs() <= SAME * value.abs()
        };
        let sides = [after, after.wrapping_sub(1)].into_iter().filter(|&i| i < self.value.len());
        let distance = |i: &usize| (x - self.value[*i]).abs();
        sides.filter(near).min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

impl Statistic for Values {
    fn size(&self) -> usize {
        self.value.len() + 1
    }

    fn add(&self, draws: &DrawBuffer, sums: &mut [f64]) {
        let strange = self.value.len();
        for &x in &draws.values[0] {
            sums[self.find(x).unwrap_or(strange)] += 1.0;
        }
    }
}

fn sorted(subject: &Subject) -> Option<(Values, Vec<f64>)> {
    let Some(Law::Atoms(atoms)) = &subject.prediction.law else { return None };
    let mut atoms = atoms.clone();
    atoms.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (value, probability) = atoms.into_iter().unzip();
    Some((Values { value }, probability))
}

impl Check for Atoms {
    fn kind(&self) -> Kind {
        Kind::Law
    }

    fn hypotheses(&self, subject: &Subject) -> usize {
        usize::from(sorted(subject).is_some() && !subject.expect_biased)
    }

    fn statistic(&self, subject: &Subject) -> Option<Box<dyn Statistic>> {
        Some(Box::new(sorted(subject)?.0))
    }

    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding> {
        let Some((values, probability)) = sorted(subject) else { return Vec::new() };
        let known = values.value.len();
        // A product of many factors may fall below the last listed power; such draws are as rare
        // as the probability that the list leaves out.
        let strange = evidence.sums[known].value();
        let left_out = (1.0 - probability.iter().sum::<f64>()).max(0.0);
        if strange > 10.0 + 10.0 * left_out * subject.draws as f64 {
            let (check, channel) = ("atoms".into(), String::new());
            let reason = format!("{strange} draws have values that theory does not know");
            return vec![Finding {
                check,
                channel,
                z: None,
                p: None,
                verdict: Verdict::Fail,
                reason,
            }];
        }
        let p = chi_square::p_value(&evidence.sums[..known], &probability);
        let what = "the values are not shared out as theory says";
        law_finding("atoms", what, p, limits).into_iter().collect()
    }
}

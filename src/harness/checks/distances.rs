//! Free-flight distances against their law: twenty equally probable bins and the atom of the rays
//! that escape, by Pearson's χ².
//!
//! ```text
//! P(s ≤ t) = 1 − T(t),  P(s = S) = T(S)
//! ```

use super::{Check, Evidence, Kind, Limits, Statistic, Subject, law_finding};
use crate::estimators::DrawBuffer;
use crate::harness::record::Finding;
use crate::stats::chi_square;
use crate::theory::Law;

/// The check of the distances.
pub struct Distances;

struct Bins {
    ends: Vec<f64>,
    escape: f64,
}

impl Statistic for Bins {
    fn size(&self) -> usize {
        self.ends.len() + 2
    }

    fn add(&self, draws: &DrawBuffer, sums: &mut [f64]) {
        for &s in &draws.values[0] {
            let bin = if s >= self.escape {
                self.ends.len() + 1
            } else {
                self.ends.partition_point(|&end| end <= s)
            };
            sums[bin] += 1.0;
        }
    }
}

impl Check for Distances {
    fn kind(&self) -> Kind {
        Kind::Law
    }

    fn hypotheses(&self, subject: &Subject) -> usize {
        let known = matches!(subject.prediction.law, Some(Law::Distances { .. }));
        usize::from(known && !subject.expect_biased)
    }

    fn statistic(&self, subject: &Subject) -> Option<Box<dyn Statistic>> {
        let Some(Law::Distances { bins, end, .. }) = &subject.prediction.law else { return None };
        Some(Box::new(Bins { ends: bins.clone(), escape: *end }))
    }

    fn judge(&self, subject: &Subject, limits: &Limits, evidence: &Evidence) -> Vec<Finding> {
        let Some(Law::Distances { bins, escape, .. }) = &subject.prediction.law else {
            return Vec::new();
        };
        let share = (1.0 - escape) / (bins.len() + 1) as f64;
        let mut probability = vec![share; bins.len() + 1];
        probability.push(*escape);
        let p = chi_square::p_value(evidence.sums, &probability);
        let what = "the distances do not follow 1 − T(s)";
        law_finding("distances", what, p, limits).into_iter().collect()
    }
}

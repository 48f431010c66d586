//! Shares of the questions of a run in its error rate, and the verdicts that are known before the first draw.
//!
//! 4/5 of α go to the gate, by e-Bonferroni, 1/5 to the p-values, by Holm.

use serde::{Deserialize, Serialize};

use crate::plan::PlannedExperiment;
use gate::session::{self, Reason, SIDE_SHARE, main_share};
use gate::stats::normal;
use gate::stats::verdict::Verdict;

/// Levels that the run's questions share, fixed before the first draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// Number of scalars that go through the gate.
    pub scalars: usize,
    /// Number of p-values.
    pub distributions: usize,
    /// Number of declared biases, which have an α of their own.
    pub biased: usize,
    /// A scalar fails at `ln E ≥ ln(K/(0.8 α))`.
    pub ln_fail: f64,
    /// A declared bias is shown at `ln E ≥ ln(K_biased/α)`.
    pub ln_biased: f64,
    /// A scalar passes at `ln P± ≥ ln(1/β)`.
    pub ln_pass: f64,
    /// Error rate that the p-values share, by Holm.
    pub distribution_alpha: f64,
    /// The z-score that the gate's level corresponds to, for plots.
    pub z: f64,
}

impl Levels {
    /// Returns the levels at which these numbers of scalars, distributions and declared biases share α.
    pub fn new(alpha: f64, [scalars, distributions, biased]: [usize; 3]) -> Self {
        let gate_alpha = main_share(1) * alpha;
        let session::Levels { ln_fail, ln_pass } = session::Levels::new(gate_alpha, scalars);
        Self {
            scalars,
            distributions,
            biased,
            ln_fail,
            ln_biased: session::Levels::new(alpha, biased).ln_fail,
            ln_pass,
            distribution_alpha: SIDE_SHARE * alpha,
            z: normal::two_sided(gate_alpha / scalars.max(1) as f64),
        }
    }

    /// Returns the levels of a quantity, or of one with a bias that must be shown.
    pub fn of(&self, expects_bias: bool) -> session::Levels {
        let ln_fail = if expects_bias { self.ln_biased } else { self.ln_fail };
        session::Levels { ln_fail, ln_pass: self.ln_pass }
    }
}

/// Best verdict of a plan that has too few draws for a pass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Foreseen {
    /// `inconclusive` or `underpowered`.
    pub verdict: Verdict,
    /// Number of draws that the checks of that verdict need; `None` if no number of draws is enough.
    pub needed: Option<f64>,
    /// Reasons of the checks that cannot pass, those of that verdict first.
    pub reasons: Vec<Reason>,
}

impl Foreseen {
    /// Returns the best verdict on one channel of an experiment; `None` if the planned draws suffice for a pass.
    pub fn of(planned: &PlannedExperiment, channel: usize) -> Option<Self> {
        let about = planned.questions.iter().filter(|q| q.channel.is_none_or(|one| one == channel));
        // A bias that must be shown needs no pass.
        let promised = about.filter(|q| !q.expects_bias || q.answer.scalar().is_none());
        let weak: Vec<(Verdict, f64, Reason)> = promised
            .filter_map(|question| {
                let (reason, needed) = question.answer.too_weak(&question.what)?;
                Some((question.too_weak, needed, reason))
            })
            .collect();
        if weak.is_empty() {
            return None;
        }
        let verdict = Verdict::worst(weak.iter().map(|one| one.0));
        let (own, others): (Vec<_>, Vec<_>) = weak.into_iter().partition(|one| one.0 == verdict);
        let needed = own.iter().map(|one| one.1).fold(0.0, f64::max);
        let needed = Some(needed).filter(|needed| needed.is_finite());
        let reasons = own.into_iter().chain(others).map(|one| one.2).collect();
        Some(Self { verdict, needed, reasons })
    }
}

//! Quantities of known variance with a tolerance that is planned before the first draw.
//!
//! ```text
//! ε            as asked; else √(27 V/n) for n planned draws, narrowed to √V/4
//! underpowered the tolerance that is asked for, or the largest that is worth a promise, needs more than n draws: the
//!              quantity may fail and never passes
//! ```
//!
//! All blocks have one design. So the sums of blocks add up in any grouping, on any number of threads and machines, and
//! a decision is final.

use super::quantity::Quantity;
use super::reason::Reason;
use super::scalar::Levels;
use crate::stats::gate::{self, Decision, Design, Evidence, GateSums, SUMS};
use crate::stats::verdict::{GateFinding, Verdict};
use numeric::fused::in_fused_code;
use numeric::sum::{Sum, sum_in_lanes, sum_of_pairs};

/// Sums of a block: those of ψ, and that of y.
pub const BLOCK_SUMS: usize = SUMS + 1;

/// A quantity with the tolerance that is fixed before the first draw.
#[derive(Debug, Clone)]
pub struct PlannedQuantity {
    /// The quantity.
    pub quantity: Quantity,
    /// Variance, tolerance and δ, and the number of draws that these are planned for.
    pub design: Design,
    /// Number of draws that the largest admissible tolerance needs.
    pub minimum: f64,
    /// Number of draws that a pass needs, where more than are planned.
    pub underpowered: Option<f64>,
}

/// Sums of the blocks so far, and the last look at them.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Trail {
    sums: [Sum; BLOCK_SUMS],
    /// Mean of y up to the look of the decision, or to the last.
    pub mean: f64,
    /// Evidence at the look of the decision, or at the last.
    pub evidence: Evidence,
    /// The decision.
    pub decision: Decision,
    /// Number of draws up to that look.
    pub draws: u64,
    /// Number of draws and ln E at every look up to that one.
    pub path: Vec<(u64, f64)>,
}

impl Default for Trail {
    fn default() -> Self {
        Self {
            sums: [Sum::default(); BLOCK_SUMS],
            mean: 0.0,
            evidence: Evidence::NONE,
            decision: Decision::Open,
            draws: 0,
            path: Vec::new(),
        }
    }
}

impl Trail {
    /// Adds the sums of the next block.
    pub fn merge(&mut self, block: &[f64]) {
        self.sums.iter_mut().zip(block).for_each(|(sum, &x)| sum.add(x));
    }
}

/// Sums of one block while draws are added.
#[derive(Default)]
pub struct BlockSums {
    psi: Box<GateSums>,
    y: f64,
}

impl BlockSums {
    /// Adds draws of y, each `times` times where that is given.
    pub fn absorb(&mut self, planned: &PlannedQuantity, y: &[f64], times: Option<&[f64]>) {
        let arguments = planned.design.arguments();
        if let Some(times) = times {
            self.psi.absorb_counted(y, times, &arguments);
            self.y += sum_of_pairs(y, times, |y, times| y * times);
        } else {
            self.psi.absorb(y, &arguments);
            self.y += in_fused_code(
                #[inline(always)]
                || sum_in_lanes(y, |y| y),
            );
        }
    }

    /// The sums.
    pub fn close(self) -> Vec<f64> {
        let mut sums = self.psi.totals().to_vec();
        sums.push(self.y);
        sums
    }
}

impl Quantity {
    /// Plans the quantity for `draws` draws, before the first of them.
    pub fn planned(self, draws: f64) -> PlannedQuantity {
        let variance = self.known_variance().unwrap_or(f64::INFINITY);
        let budget = gate::tolerance_of(variance, draws);
        let design = Design::new(variance, self.tolerance.unwrap_or(budget), self.floor);
        let widest = self.tolerance.unwrap_or(self.cap);
        let needs = |tolerance| gate::draws_of(variance, tolerance);
        // A tolerance below the prediction's own error cannot be reached.
        let blurred = design.tolerance > widest * (1.0 + 1e-9) && 4.0 * self.floor > widest;
        let underpowered = if blurred {
            Some(f64::INFINITY)
        } else {
            let needed = needs(design.tolerance.min(widest));
            (needed > draws * (1.0 + 1e-6)).then_some(needed)
        };
        let minimum = needs(Design::new(variance, widest, self.floor).tolerance);
        PlannedQuantity { quantity: self, design, minimum, underpowered }
    }
}

impl PlannedQuantity {
    /// A look at the sums of `draws` draws, unless an earlier one has decided.
    pub fn look(&self, trail: &mut Trail, draws: u64, levels: Levels) {
        if trail.decision != Decision::Open {
            return;
        }
        let [psi @ .., y] = trail.sums.map(|sum| sum.value());
        trail.mean = y / draws as f64;
        trail.evidence = self.design.evidence(psi, draws as f64);
        trail.draws = draws;
        trail.path.push((draws, trail.evidence.ln_e));
        trail.decision = trail.evidence.decision(levels.ln_fail, levels.ln_pass);
        if trail.decision == Decision::Passed && self.underpowered.is_some() {
            trail.decision = Decision::Open;
        }
    }

    /// The numbers at the last look.
    pub fn finding(&self, trail: &Trail, levels: Levels) -> GateFinding {
        let seen = (trail.mean, trail.draws);
        let result = levels.finding(&self.design, trail.evidence, seen, trail.decision);
        GateFinding { needed: self.underpowered, ..result }
    }

    /// Reason why the plan is too short for a pass; `None` if it is long enough.
    pub fn too_short(&self) -> Option<Reason> {
        let (what, floor) = (self.quantity.what.clone(), self.design.floor);
        self.underpowered.map(|needed| Reason::TooFewPlanned { what, needed, floor })
    }

    /// The verdict; `too_weak` is the verdict on a quantity that need not pass, `remark` is added to a deviation.
    pub fn verdict(
        &self,
        trail: &Trail,
        levels: Levels,
        too_weak: Verdict,
        remark: impl FnOnce() -> String,
    ) -> (Verdict, Option<Reason>) {
        let (quantity, mean, draws) = (&self.quantity, trail.mean, trail.draws);
        match (trail.decision, self.too_short()) {
            (Decision::Passed, _) => (Verdict::Pass, None),
            (Decision::Failed, _) => {
                let error = (self.design.variance / draws as f64).sqrt();
                let off = Reason::Off {
                    what: quantity.what.clone(),
                    off: quantity.deviation(mean, draws).with_z(mean / error),
                    remark: remark(),
                    ln_e: trail.evidence.ln_e,
                    limit: levels.ln_fail,
                    tolerance: None,
                };
                (Verdict::Fail, Some(off))
            }
            (Decision::Open, Some(reason)) => (too_weak, Some(reason)),
            (Decision::Open, None) => {
                let (tolerance, planned) = (self.design.tolerance, self.design.draws());
                (Verdict::Inconclusive, Some(quantity.undecided(draws, tolerance, planned)))
            }
        }
    }

    /// The verdict on a bias that is declared and must be shown; `was_cut` if not all planned draws were made.
    pub fn verdict_on_bias(
        &self,
        trail: &Trail,
        levels: Levels,
        was_cut: bool,
    ) -> (Verdict, Option<Reason>) {
        let (verdict, reason) = match trail.decision {
            Decision::Failed => (Verdict::Pass, Reason::BiasShown(trail.mean)),
            Decision::Open if was_cut => (Verdict::Inconclusive, Reason::BiasNotShown(trail.draws)),
            _ => {
                let (bias, ln_e) = (trail.mean, trail.evidence.ln_e);
                (Verdict::Fail, Reason::SmallBias { bias, ln_e, limit: levels.ln_fail })
            }
        };
        (verdict, Some(reason))
    }
}

//! Quantities of a draw that go through the gate: a mean of 0 with a known variance.

use super::batch::{Batch, Observe};
use super::check::{
    BufferPlace, Check, CheckResult, Context, ErrorShare, Look, Observer, Subject, Total,
};
use gate::CheckId;
use gate::deviation::signed_percent;
use gate::session::{BlockSums, PlannedQuantity, Quantity, Reason, Trail, VarianceBound};
use gate::stats::gate::Decision;
use gate::stats::verdict::BLOCK;
use numeric::digits::short;

/// Quantity y of each draw that has mean 0 and a known variance if the draws are correct.
pub struct ScalarCheck {
    /// y.
    pub observe: Observe,
    /// Number added to every y: 0, except where a bias is added on purpose.
    pub bias: f64,
    /// Quantity and its tolerance.
    pub planned: PlannedQuantity,
}

/// Returns the ground for an upper bound of a variance: the variance and its relative error bound.
pub fn variance(variance: f64, error: f64) -> Option<VarianceBound> {
    Some(VarianceBound::Variance(variance * (1.0 + error)))
}

impl ScalarCheck {
    /// Plans a quantity: ε from the case, or from the planned draws.
    pub fn new(subject: &Subject, quantity: Quantity, observe: Observe) -> Self {
        Self { observe, bias: 0.0, planned: quantity.planned(subject.draws as f64) }
    }

    /// Returns a remark about a deviation: a thin medium is judged by its opacity, a thick one in units of its own.
    fn remark(&self, trail: &Trail, log_unit: f64) -> String {
        let Quantity { check, expected, scale, .. } = self.planned.quantity;
        let mut text = String::new();
        if check != CheckId::Mean {
            return text;
        }
        if (scale - expected.abs()).abs() > 1e-9 * scale {
            text = format!(", {} of the opacity", signed_percent(trail.mean));
        }
        if log_unit != 0.0 {
            text = format!("{text}, in units of exp(−{})", short(log_unit, 6));
        }
        text
    }
}

impl Check for ScalarCheck {
    fn share(&self) -> ErrorShare {
        ErrorShare::Gate
    }

    fn total(&self) -> Total {
        Total { trail: Some(Trail::default()), ..Total::default() }
    }

    fn observe(&self) -> Box<dyn Observer + '_> {
        Box::new(Sums { scalar: self, sums: BlockSums::default() })
    }

    fn merge(&self, total: &mut Total, block: &[f64], _: u64) {
        total.trail.get_or_insert_default().merge(block);
    }

    fn look(&self, total: &mut Total, look: Look) -> bool {
        let trail = total.trail.get_or_insert_default();
        self.planned.look(trail, look.draws, look.levels);
        let was_promised = self.planned.underpowered.is_none() || look.draws < look.planned;
        trail.decision == Decision::Open && was_promised
    }

    fn has_failed(&self, total: &Total) -> bool {
        total.trail.as_ref().is_some_and(|trail| trail.decision == Decision::Failed)
    }

    fn finish(&self, total: &Total, context: &Context) -> CheckResult {
        // Without a look there is no evidence.
        let (trail, levels) = (total.trail.clone().unwrap_or_default(), context.look.levels);
        let (verdict, reason) = if context.expects_bias {
            let was_cut = context.look.draws < context.look.planned;
            self.planned.verdict_on_bias(&trail, levels, was_cut)
        } else {
            let remark = || self.remark(&trail, context.log_unit);
            self.planned.verdict(&trail, levels, context.too_weak, remark)
        };
        CheckResult {
            gate: Some(self.planned.finding(&trail, levels)),
            block: Some(trail.draws.saturating_sub(1) / BLOCK),
            path: trail.path.iter().map(|&(draws, ln_e)| [draws as f64, ln_e]).collect(),
            ..CheckResult::new(verdict, reason)
        }
    }

    fn too_weak(&self, _: &str) -> Option<(Reason, f64)> {
        self.planned.too_short().zip(self.planned.underpowered)
    }

    fn scalar(&self) -> Option<&ScalarCheck> {
        Some(self)
    }

    fn shift(&mut self, tolerances: f64) {
        self.bias += tolerances * self.planned.design.tolerance;
    }
}

/// Sums of a block.
struct Sums<'a> {
    scalar: &'a ScalarCheck,
    sums: BlockSums,
}

impl Observer for Sums<'_> {
    fn absorb(&mut self, draws: &Batch, _: BufferPlace, y: &mut Vec<f64>) {
        let Self { scalar, sums } = self;
        draws.observe(&scalar.observe, y, |y, times| {
            if scalar.bias != 0.0 {
                for y in y.iter_mut() {
                    *y += scalar.bias;
                }
            }
            sums.absorb(&scalar.planned, y, times);
        });
    }

    fn close(self: Box<Self>, _: usize) -> Vec<f64> {
        self.sums.close()
    }
}

//! Bounds that every draw must keep.

use super::batch::Batch;
use super::check::{BufferPlace, Check, CheckResult, Context, Observer, Total};
use estimators::DrawBuffer;
use gate::session::Reason;
use gate::stats::verdict::Verdict;

/// A bound that every draw must keep.
pub struct Always {
    /// Returns the largest value over a buffer, or NaN where a draw is not a finite number.
    pub largest: Box<dyn Fn(&DrawBuffer) -> f64 + Send + Sync>,
    /// Largest allowed value.
    pub bound: f64,
    /// True if it is a bound on the number of lookups, which all draws share.
    pub is_of_lookups: bool,
}

impl Always {
    /// Returns a bound on the deviation of a draw that rounding explains.
    pub fn new(largest: impl Fn(&DrawBuffer) -> f64 + Send + Sync + 'static, bound: f64) -> Self {
        Self { largest: Box::new(largest), bound, is_of_lookups: false }
    }
}

impl Check for Always {
    fn observe(&self) -> Box<dyn Observer + '_> {
        Box::new(Largest { always: self, largest: 0.0 })
    }

    fn join(&self, block: &mut [f64], next: &[f64]) {
        block.iter_mut().zip(next).for_each(|(maximum, &other)| *maximum = larger(*maximum, other));
    }

    fn merge(&self, total: &mut Total, block: &[f64], number: u64) {
        for &other in block {
            let largest = larger(total.largest.0, other);
            if largest.to_bits() != total.largest.0.to_bits() {
                total.largest = (largest, number);
            }
        }
    }

    fn has_failed(&self, total: &Total) -> bool {
        let (largest, _) = total.largest;
        largest.is_nan() || largest > self.bound
    }

    fn finish(&self, total: &Total, context: &Context) -> CheckResult {
        let (largest, block) = total.largest;
        let (verdict, reason) = self.verdict(largest, context);
        let block = (verdict == Verdict::Fail).then_some(block);
        CheckResult { block, ..CheckResult::new(verdict, reason) }
    }
}

impl Always {
    fn verdict(&self, largest: f64, context: &Context) -> (Verdict, Option<Reason>) {
        let is_kept = largest <= self.bound;
        if context.expects_bias {
            return if is_kept {
                (Verdict::Fail, Some(Reason::NoBias))
            } else {
                (Verdict::Pass, Some(Reason::BiasShown(largest)))
            };
        }
        if is_kept {
            return (Verdict::Pass, None);
        }
        let reason = if largest.is_nan() {
            Reason::NotFinite
        } else if self.is_of_lookups {
            Reason::LookupsOff(largest)
        } else {
            let (what, bound) = (context.what.to_owned().into(), self.bound);
            match context.mean {
                Some(off) => Reason::MeanOff { what, off, largest, bound },
                None => Reason::DrawOff { what, largest, bound },
            }
        };
        (Verdict::Fail, Some(reason))
    }
}

/// Largest value of a block.
struct Largest<'a> {
    always: &'a Always,
    largest: f64,
}

impl Observer for Largest<'_> {
    fn absorb(&mut self, draws: &Batch, _: BufferPlace, _: &mut Vec<f64>) {
        self.largest = larger(self.largest, (self.always.largest)(draws.draws));
    }

    fn close(self: Box<Self>, _: usize) -> Vec<f64> {
        vec![self.largest]
    }
}

/// Returns the maximum of two numbers; NaN if one of them is NaN.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

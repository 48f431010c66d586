//! Checks with a p-value: tests of a whole distribution over the first draws, and inspections of an experiment and its
//! streams after the draws.

use std::panic::{RefUnwindSafe, UnwindSafe};

use super::batch::Batch;
use super::check::{BufferPlace, Check, CheckResult, Context, ErrorShare, Observer, Total};
use estimators::{DrawBuffer, Experiment};
use gate::session::Reason;
use gate::stats::verdict::Verdict;
use numeric::rng::Streams;
use numeric::sum::Sum;

/// A test of a whole distribution by sums over the first draws.
pub trait DistributionTest: Send + Sync + UnwindSafe + RefUnwindSafe {
    /// Returns the number of sums.
    fn size(&self) -> usize;

    /// Adds the draws of a buffer to the sums of the block; the first of them is the block's draw number `first`.
    fn add(&self, draws: &Batch, first: usize, sums: &mut [f64]);

    /// Turns the sums of a block of `draws` draws into terms that are summed over blocks.
    fn close(&self, draws: usize, sums: &mut [f64]) {
        let _ = (draws, sums);
    }

    /// Returns the p-value of the sums over `draws` draws; `None` if they test nothing.
    fn p_value(&self, sums: &[f64], draws: f64) -> Option<f64>;

    /// Returns details beside the p-value, in words; may be empty.
    fn details(&self, sums: &[f64], draws: f64) -> String {
        let _ = (sums, draws);
        String::new()
    }
}

impl<L: DistributionTest> Check for L {
    fn share(&self) -> ErrorShare {
        ErrorShare::PValues
    }

    fn total(&self) -> Total {
        Total { sums: vec![Sum::default(); self.size()], ..Total::default() }
    }

    fn observe(&self) -> Box<dyn Observer + '_> {
        Box::new(DistributionSums { of: self, sums: vec![0.0; self.size()] })
    }

    fn finish(&self, total: &Total, context: &Context) -> CheckResult {
        let (draws, fixed, what) = (context.look.draws, context.fixed, context.what.to_owned());
        if draws < fixed {
            let reason = Reason::Cut { what: what.into(), draws, fixed };
            return CheckResult::new(Verdict::Inconclusive, Some(reason));
        }
        let sums: Vec<f64> = total.sums.iter().map(Sum::value).collect();
        match self.p_value(&sums, fixed as f64) {
            // All p-values of a run are judged together.
            Some(p) => CheckResult { p: Some(p), ..CheckResult::new(Verdict::Pass, None) },
            None => CheckResult::new(Verdict::Underpowered, Some(Reason::TooFew(what.into()))),
        }
    }
}

/// Sums of a block.
struct DistributionSums<'a, L: DistributionTest> {
    of: &'a L,
    sums: Vec<f64>,
}

impl<L: DistributionTest> Observer for DistributionSums<'_, L> {
    fn absorb(&mut self, draws: &Batch, place: BufferPlace, _: &mut Vec<f64>) {
        if place.is_fixed {
            self.of.add(draws, place.first, &mut self.sums);
        }
    }

    fn close(mut self: Box<Self>, fixed: usize) -> Vec<f64> {
        if fixed == 0 {
            // No fixed draw: no sums.
            return Vec::new();
        }
        self.of.close(fixed, &mut self.sums);
        self.sums
    }
}

/// Experiment with its streams, for checks that inspect them.
pub struct Inspected<'a> {
    /// Experiment.
    pub experiment: &'a dyn Experiment,
    /// Number of channels of a draw.
    pub channels: usize,
    /// Returns the streams of a block.
    pub streams: &'a dyn Fn(u64) -> Streams,
    /// Number of blocks.
    pub blocks: u64,
}

impl Inspected<'_> {
    /// Returns the first `count` values of the first block's draws, last channel.
    pub fn first_draws(&self, count: u64) -> Vec<f64> {
        let mut streams = (self.streams)(0);
        let mut buffer = DrawBuffer::new(self.channels);
        let (length, mut values) = (DrawBuffer::length(self.channels), Vec::new());
        while (values.len() as u64) < count {
            self.experiment.fill(&mut streams, length, &mut buffer);
            values.extend(buffer.values.iter().last().into_iter().flatten());
        }
        values
    }
}

/// Function that returns a p-value.
pub struct Inspection<F>(pub F);

impl<F: Fn(&Inspected) -> f64 + Send + Sync> Check for Inspection<F> {
    fn share(&self) -> ErrorShare {
        ErrorShare::PValues
    }

    fn finish(&self, _: &Total, context: &Context) -> CheckResult {
        let p = Some((self.0)(context.inspected));
        // All p-values of a run are judged together.
        CheckResult { p, ..CheckResult::new(Verdict::Pass, None) }
    }
}

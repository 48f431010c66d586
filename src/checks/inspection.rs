//! Inspections of an experiment and its streams, after the draws.

use super::check::{Check, Context, Found, Share, Total};
use ::gate::stats::verdict::Verdict;
use estimators::{DrawBuffer, Experiment};
use numeric::rng::Streams;

/// An experiment with its streams, for checks that look for themselves.
pub struct Inspected<'a> {
    /// The experiment.
    pub experiment: &'a dyn Experiment,
    /// The channels of a draw.
    pub channels: usize,
    /// The streams of each block.
    pub streams: &'a dyn Fn(u64) -> Streams,
    /// Number of blocks.
    pub blocks: u64,
}

impl Inspected<'_> {
    /// The first `count` values of the first block's draws, last channel.
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

/// A function that returns a p-value.
pub struct Inspection<F>(pub F);

impl<F: Fn(&Inspected) -> f64 + Send + Sync> Check for Inspection<F> {
    fn share(&self) -> Share {
        Share::PValues
    }

    fn finish(&self, _: &Total, context: &Context) -> Found {
        let p = Some((self.0)(context.inspected));
        // All p-values of a run are judged together.
        Found { p, ..Found::new(Verdict::Pass, None) }
    }
}

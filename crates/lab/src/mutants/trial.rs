//! An experiment that draws as a mutant does.

use std::sync::Arc;

use estimators::{DrawBuffer, Estimated, Experiment, Kernel, Request, Setup};
use numeric::rng::Streams;

/// The draws between two beginnings of a generator that starts again.
const PERIOD: usize = 1024;

/// Function that makes the draws of a request, with or without a bug.
pub type Draws<P> = dyn Fn(&Setup<P>, Request) + Send + Sync;

/// Draws on a setup.
pub struct Trial<P: Estimated> {
    pub draws: Arc<Draws<P>>,
    pub setup: Setup<P>,
    /// True if every 1024 draws begin with the same random numbers, which is wrong.
    pub replays: bool,
}

impl<P: Estimated> Experiment for Trial<P> {
    fn fill_by(&self, _: Kernel, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        let made = if self.replays { count.min(PERIOD) } else { count };
        (self.draws)(&self.setup, Request { streams, count: made, buffer });
        buffer.repeat(count);
    }
}

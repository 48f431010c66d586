//! The loop over a mutant's draws; the estimators' own is in `estimators/trial.rs`.

use std::sync::Arc;

use fearless_simd::Level;

use estimators::{Draw, DrawBuffer, Experiment, Kernel, Setup};
use media::Lookups;
use numeric::rng::{Stream, Streams};
use theory::problems::Problem;

/// The draws between two beginnings of a generator that starts again.
const PERIOD: usize = 1024;

/// Makes one draw, rightly or wrongly.
pub type Draws<P> =
    dyn Fn(&Setup<P>, &Lookups, &mut Stream) -> Draw<<P as Problem>::Value> + Send + Sync;

/// Draws on a setup.
pub struct Trial<P: Problem> {
    /// How they are made.
    pub draws: Arc<Draws<P>>,
    /// What they are made on.
    pub setup: Setup<P>,
    /// Whether every 1024 draws begin with the same random numbers, which is wrong.
    pub replays: bool,
}

impl<P: Problem> Experiment for Trial<P> {
    fn fill_by(&self, _: Kernel, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        buffer.clear();
        let begin = streams.clone();
        let medium = &self.setup.problem.lookups(Level::new());
        for number in 0..count {
            if self.replays && number % PERIOD == 0 {
                streams.clone_from(&begin);
            }
            buffer.push(&(self.draws)(&self.setup, medium, streams.of_next_draw()));
        }
    }
}

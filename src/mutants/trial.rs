//! The loop over a mutant's draws; the estimators' own is in `estimators/trial.rs`.

use fearless_simd::Level;

use crate::estimators::{Draw, DrawBuffer, Experiment, Kernel, Setup};
use crate::media::Lookups;
use crate::numeric::pack::in_fused_code;
use crate::problems::Problem;
use crate::rng::{Stream, Streams};

/// The draws between two beginnings of a generator that starts again.
pub const PERIOD: usize = 1024;

/// A way to make draws, right or wrong.
pub trait Draws<P: Problem>: Clone + Send + Sync + 'static {
    /// Whether every [`PERIOD`] draws begin with the same random numbers, which is wrong.
    fn replays(&self) -> bool {
        false
    }

    /// Prepares what it works on, once per experiment.
    fn prepare(&self, setup: Setup<P>) -> Setup<P> {
        setup
    }

    /// Makes one draw.
    fn draw(&self, setup: &Setup<P>, medium: &Lookups, rng: &mut Stream) -> Draw<P::Value>;
}

/// Joins a way to draw and a setup.
pub fn experiment<P: Problem, D: Draws<P>>(draws: D, setup: Setup<P>) -> Box<dyn Experiment> {
    let setup = draws.prepare(setup);
    Box::new(Trial { draws, setup })
}

struct Trial<P, D> {
    draws: D,
    setup: Setup<P>,
}

impl<P: Problem, D: Draws<P>> Experiment for Trial<P, D> {
    fn fill_by(&self, _: Kernel, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        buffer.clear();
        let begin = streams.clone();
        let replays = self.draws.replays();
        let medium = &self.setup.problem.medium().lookups(Level::new());
        in_fused_code(
            #[inline(always)]
            || {
                for number in 0..count {
                    if replays && number % PERIOD == 0 {
                        streams.clone_from(&begin);
                    }
                    let draw = self.draws.draw(&self.setup, medium, streams.of_next_draw());
                    buffer.push(&draw);
                }
            },
        );
    }
}

//! The loop over a mutant's draws; the estimators' own is in `estimators/trial.rs`.

use crate::estimators::{Draw, DrawBuffer, Experiment, Setup};
use crate::media::{Extinction, FreeFlight, Visitor};
use crate::problems::Problem;
use crate::rng::Stream;

/// A way to make draws, right or wrong.
pub trait Draws<P: Problem>: Clone + Send + Sync + 'static {
    /// Whether all buffers of a block begin with the same random numbers, which is wrong.
    const REPLAYS: bool = false;

    /// Prepares what it works on, once per experiment.
    #[must_use]
    fn prepare(&self, setup: Setup<P>) -> Setup<P> {
        setup
    }

    /// Makes one draw.
    fn draw<M: Extinction>(&self, setup: &Setup<P>, medium: &M, rng: &mut Stream)
    -> Draw<P::Value>;
}

/// Joins a way to draw and a setup.
#[must_use]
pub fn experiment<P: Problem, D: Draws<P>>(draws: D, setup: Setup<P>) -> Box<dyn Experiment> {
    let setup = draws.prepare(setup);
    Box::new(Trial { draws, setup })
}

struct Trial<P, D> {
    draws: D,
    setup: Setup<P>,
}

impl<P: Problem, D: Draws<P>> Experiment for Trial<P, D> {
    fn fill(&self, rng: &mut Stream, count: usize, buffer: &mut DrawBuffer) {
        buffer.clear();
        let mut copy = rng.clone();
        let rng = if D::REPLAYS { &mut copy } else { rng };
        self.setup.problem.medium().profile().visit(Fill { trial: self, rng, count, buffer });
    }
}

struct Fill<'a, P, D> {
    trial: &'a Trial<P, D>,
    rng: &'a mut Stream,
    count: usize,
    buffer: &'a mut DrawBuffer,
}

impl<P: Problem, D: Draws<P>> Visitor for Fill<'_, P, D> {
    type Output = ();

    fn visit<F: FreeFlight>(self, field: &F) {
        for _ in 0..self.count {
            let draw = self.trial.draws.draw(&self.trial.setup, field, self.rng);
            self.buffer.push(&draw);
        }
    }
}

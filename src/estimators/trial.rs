//! An estimator on a problem, with its type erased: what the harness drives.

use super::{Draw, Estimator, Inputs, Portrait, Refusal, Setup, controls};
use crate::media::{FreeFlight, Visitor};
use crate::problems::Problem;
use crate::rng::{Address, Stream};
use crate::theory::Prediction;

/// A buffer of draws: one array per channel, one for the lookups, one for the defects.
#[derive(Debug, Clone)]
pub struct DrawBuffer {
    /// `values[channel][draw]`.
    pub values: Vec<Vec<f64>>,
    /// `lookups[draw]`.
    pub lookups: Vec<u32>,
    /// `defects[draw]`, see [`Draw::defect`].
    pub defects: Vec<f64>,
}

impl DrawBuffer {
    /// How many draws a buffer holds: small enough for the first-level cache.
    pub const LENGTH: usize = 1024;

    /// An empty buffer for draws of the given number of channels.
    #[must_use]
    pub fn new(channels: usize) -> Self {
        let values = vec![Vec::with_capacity(Self::LENGTH); channels];
        let (lookups, defects) =
            (Vec::with_capacity(Self::LENGTH), Vec::with_capacity(Self::LENGTH));
        Self { values, lookups, defects }
    }

    /// Removes the draws.
    pub fn clear(&mut self) {
        self.values.iter_mut().for_each(Vec::clear);
        self.lookups.clear();
        self.defects.clear();
    }

    /// Adds a draw.
    #[inline]
    pub fn push<V: AsRef<[f64]>>(&mut self, draw: &Draw<V>) {
        for (channel, &value) in self.values.iter_mut().zip(draw.value.as_ref()) {
            channel.push(value);
        }
        self.lookups.push(draw.lookups);
        self.defects.push(draw.defect);
    }
}

/// An estimator on a problem.
pub trait Experiment: Send + Sync {
    /// Replaces the buffer's draws by the next `count` of the stream: one virtual call a buffer.
    fn fill(&self, rng: &mut Stream, count: usize, buffer: &mut DrawBuffer);

    /// See [`Estimator::KEEPS_BOOKS`].
    fn keeps_books(&self) -> bool {
        false
    }
}

/// An estimator as written in a case, with its type erased.
pub trait Entry<P: Problem>: Send + Sync {
    /// See [`Estimator::INPUTS`].
    fn inputs(&self) -> Inputs;
    /// See [`Estimator::label`].
    fn label(&self, albedo: bool) -> String;
    /// See [`Estimator::with_albedo`].
    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>>;
    /// See [`Estimator::default_control`].
    fn default_control(&self) -> Option<Box<dyn controls::Recipe>>;
    /// See [`Estimator::domain`].
    ///
    /// # Errors
    ///
    /// The violated inequality and where on the ray.
    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal>;
    /// See [`Estimator::predict`].
    fn predict(&self, setup: &Setup<P>) -> Prediction;
    /// See [`Estimator::portrait`].
    fn portrait(&self, setup: &Setup<P>, address: Address) -> Option<Portrait>;
    /// Joins the estimator and its setup.
    fn experiment(&self, setup: Setup<P>) -> Box<dyn Experiment>;
}

impl<P: Problem, E: Estimator<P>> Entry<P> for E {
    fn inputs(&self) -> Inputs {
        E::INPUTS
    }

    fn label(&self, albedo: bool) -> String {
        Estimator::label(self, albedo)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>> {
        Estimator::with_albedo(self, albedo).map(|page| Box::new(page) as Box<dyn Entry<P>>)
    }

    fn default_control(&self) -> Option<Box<dyn controls::Recipe>> {
        E::default_control()
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        Estimator::domain(self, setup)
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        Estimator::predict(self, setup)
    }

    fn portrait(&self, setup: &Setup<P>, address: Address) -> Option<Portrait> {
        Estimator::portrait(self, setup, address)
    }

    fn experiment(&self, setup: Setup<P>) -> Box<dyn Experiment> {
        Box::new(Trial { estimator: self.clone(), setup })
    }
}

struct Trial<P, E> {
    estimator: E,
    setup: Setup<P>,
}

impl<P: Problem, E: Estimator<P>> Experiment for Trial<P, E> {
    fn fill(&self, rng: &mut Stream, count: usize, buffer: &mut DrawBuffer) {
        buffer.clear();
        self.setup.problem.medium().profile().visit(Fill { trial: self, rng, count, buffer });
    }

    fn keeps_books(&self) -> bool {
        E::KEEPS_BOOKS
    }
}

/// The loop over draws, compiled once per estimator and field type.
struct Fill<'a, P, E> {
    trial: &'a Trial<P, E>,
    rng: &'a mut Stream,
    count: usize,
    buffer: &'a mut DrawBuffer,
}

impl<P: Problem, E: Estimator<P>> Visitor for Fill<'_, P, E> {
    type Output = ();

    fn visit<F: FreeFlight>(self, field: &F) {
        for _ in 0..self.count {
            let draw = self.trial.estimator.draw(&self.trial.setup, field, self.rng);
            self.buffer.push(&draw);
        }
    }
}

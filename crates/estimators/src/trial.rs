//! An estimator on a problem, with its type erased: the interface of the harness.

use fearless_simd::Level;

use super::{DrawBuffer, Estimated, Estimator, Fields, Inputs, RayView, Refusal, Setup};
use crate::Request;
use crate::recipes::controls;
use numeric::rng::{Address, Streams};
use theory::Prediction;

/// A way to make draws; all ways make the same draws.
#[derive(Debug, Clone, Copy)]
pub enum Kernel {
    /// One draw after the other.
    Single,
    /// Eight draws at a time on the hardware of this level, for estimators that can.
    Packets(Level),
}

/// An estimator on a problem.
pub trait Experiment: Send + Sync {
    /// Replaces the buffer's draws by the next `count` of the block: one virtual call a buffer.
    fn fill_by(&self, kernel: Kernel, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer);

    /// Replaces the buffer's draws as [`Experiment::fill_by`] does, by the best kernel of the machine.
    fn fill(&self, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        self.fill_by(Kernel::Packets(Level::new()), streams, count, buffer);
    }

    /// See [`Estimator::HAS_INVARIANT`].
    fn has_invariant(&self) -> bool {
        false
    }

    /// The share of the ray's support, or in space of the box about the volume, on which σ̂ is 0 because collisions
    /// there would change nothing.
    fn skipped(&self) -> f64 {
        0.0
    }
}

/// An estimator as written in a case, with its type erased.
pub trait Entry<P: Estimated>: Send + Sync {
    /// See [`Estimator::inputs`].
    fn inputs(&self) -> Inputs;
    /// See [`Estimator::INPUTS`].
    fn may_take(&self) -> Inputs;
    /// See [`Estimator::label`].
    fn label(&self, albedo: bool) -> String;
    /// See [`Estimator::with_albedo`].
    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>>;
    /// See [`Estimator::without_control`].
    fn without_control(&self) -> Option<&'static str>;
    /// See [`Estimator::default_control`].
    fn default_control(&self) -> Option<Box<dyn controls::Recipe>>;
    /// See [`Estimator::needs`].
    fn needs(&self) -> Option<&'static str>;
    /// See [`Estimator::domain`].
    ///
    /// # Errors
    ///
    /// The violated inequality and where on the ray.
    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal>;
    /// See [`Estimator::predict`].
    fn predict(&self, setup: &Setup<P>) -> Prediction;
    /// See [`Estimator::ray_view`].
    fn ray_view(&self, setup: &Setup<P>, address: Address) -> Option<RayView>;
    /// See [`Estimator::SKIPS`].
    fn skips(&self) -> bool;
    /// Joins the estimator and its setup.
    fn experiment(&self, setup: Setup<P>) -> Box<dyn Experiment>;
}

impl<P: Estimated, E: Estimator<P>> Entry<P> for E {
    fn inputs(&self) -> Inputs {
        Estimator::inputs(self)
    }

    fn may_take(&self) -> Inputs {
        Self::INPUTS
    }

    fn label(&self, albedo: bool) -> String {
        Estimator::label(self, albedo)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>> {
        Estimator::with_albedo(self, albedo).map(|page| Box::new(page) as Box<dyn Entry<P>>)
    }

    fn without_control(&self) -> Option<&'static str> {
        E::without_control()
    }

    fn default_control(&self) -> Option<Box<dyn controls::Recipe>> {
        E::default_control()
    }

    fn needs(&self) -> Option<&'static str> {
        Estimator::needs(self)
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        Estimator::domain(self, setup)
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        Estimator::predict(self, setup)
    }

    fn ray_view(&self, setup: &Setup<P>, address: Address) -> Option<RayView> {
        Estimator::ray_view(self, setup, address)
    }

    fn skips(&self) -> bool {
        E::SKIPS
    }

    fn experiment(&self, setup: Setup<P>) -> Box<dyn Experiment> {
        Box::new(Prepared { estimator: self.clone(), setup })
    }
}

struct Prepared<P: Estimated, E> {
    estimator: E,
    setup: Setup<P>,
}

impl<P: Estimated, E: Estimator<P>> Experiment for Prepared<P, E> {
    fn fill_by(
        &self,
        kernel: Kernel,
        streams: &mut Streams,
        count: usize,
        buffer: &mut DrawBuffer,
    ) {
        self.estimator.fill(kernel, &self.setup, Request { streams, count, buffer });
    }

    fn has_invariant(&self) -> bool {
        E::HAS_INVARIANT
    }

    fn skipped(&self) -> f64 {
        self.setup.fields.skipped()
    }
}

//! Estimators and experiments with their types erased: the interface of the harness.

use std::any::Any;

use fearless_simd::Level;

use super::{DrawBuffer, Estimated, Estimator, Fields, RayView, Refusal, Setup, Traits};
use crate::Request;
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

/// A source of draws.
pub trait Experiment: Send + Sync {
    /// Replaces the buffer's draws by the next `count` of the block: one virtual call a buffer.
    fn fill_by(&self, kernel: Kernel, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer);

    /// Replaces the buffer's draws as [`Experiment::fill_by`] does, by the best kernel of the machine.
    fn fill(&self, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        self.fill_by(Kernel::Packets(Level::new()), streams, count, buffer);
    }

    /// True if draws have a [`Draw::defect`](super::Draw::defect).
    fn has_invariant(&self) -> bool {
        false
    }

    /// The share of the ray's support, or in space of the box about the volume, on which σ̂ is 0 because collisions
    /// there would change nothing.
    fn skipped(&self) -> f64 {
        0.0
    }
}

/// An estimator joined with its setup.
pub trait Joined: Experiment {
    /// Checks that the estimator exists and is unbiased.
    ///
    /// # Errors
    ///
    /// The violated inequality and where on the ray.
    fn domain(&self) -> Result<(), Refusal>;

    /// Returns the prediction for a draw.
    fn predict(&self) -> Prediction;

    /// Returns the ray seen from the side, for estimators of a curve.
    fn ray_view(&self, address: Address) -> Option<RayView>;

    /// Returns the [`Setup`], for draws that are made outside the catalogue.
    fn into_setup(self: Box<Self>) -> Box<dyn Any>;
}

/// An estimator as written in a case.
pub trait Entry<P: Estimated>: Send + Sync {
    /// Returns [`Estimator::traits`].
    fn traits(&self) -> Traits;

    /// Returns [`Estimator::with_albedo`].
    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>>;

    /// Joins the estimator and its setup. σ̂ becomes 0 where collisions would change nothing but the cost.
    fn join(&self, setup: Setup<P>) -> Box<dyn Joined>;
}

impl<P: Estimated, E: Estimator<P>> Entry<P> for E {
    fn traits(&self) -> Traits {
        Estimator::traits(self)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Box<dyn Entry<P>>> {
        Estimator::with_albedo(self, albedo).map(|page| Box::new(page) as Box<dyn Entry<P>>)
    }

    fn join(&self, mut setup: Setup<P>) -> Box<dyn Joined> {
        let Traits { skips, has_invariant, .. } = Estimator::traits(self);
        if skips {
            setup.fields = setup.fields.skipping();
        }
        Box::new(Prepared { estimator: self.clone(), setup, has_invariant })
    }
}

struct Prepared<P: Estimated, E> {
    estimator: E,
    setup: Setup<P>,
    has_invariant: bool,
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
        self.has_invariant
    }

    fn skipped(&self) -> f64 {
        self.setup.fields.skipped()
    }
}

impl<P: Estimated, E: Estimator<P>> Joined for Prepared<P, E> {
    fn domain(&self) -> Result<(), Refusal> {
        self.estimator.domain(&self.setup)
    }

    fn predict(&self) -> Prediction {
        self.estimator.predict(&self.setup)
    }

    fn ray_view(&self, address: Address) -> Option<RayView> {
        self.estimator.ray_view(&self.setup, address)
    }

    fn into_setup(self: Box<Self>) -> Box<dyn Any> {
        Box::new(self.setup)
    }
}

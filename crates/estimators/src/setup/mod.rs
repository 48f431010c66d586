//! Medium, σ̂ and control of an estimator, prepared once per experiment, and the requirements on them.

pub mod channels;
pub mod heroes;
pub mod heuristic;
pub mod line;
pub mod residual;
pub mod walker;

use std::sync::Arc;

use crate::Estimated;
use crate::recipes::Refusal;
use crate::space::Walked;
use media::{Control, Majorants, Piecewise, Volume};
use theory::Mesh;

pub use channels::{ChannelFields, ChannelMedia};
pub use line::{ControlledLine, Line, OnRay};
pub use residual::Residual;

/// Smallest transmittance of which the ratio of a draw to the truth is still a double.
pub const FAINTEST: f64 = 1e-300;

/// A problem with the fields that its estimators work on.
pub struct Setup<P: Estimated> {
    /// Problem.
    pub problem: Arc<P>,
    /// Medium, σ̂ and control, as far as the problem has them.
    pub fields: P::Fields,
    /// True if predictions hold whole distributions; a search for optima leaves them out.
    pub distributions: bool,
}

impl<P: Estimated> Setup<P> {
    /// Prepares the fields of a problem, at the swept albedo if there is one.
    ///
    /// # Errors
    ///
    /// σ̂ that the problem cannot use.
    pub fn new(problem: &Arc<P>, parts: Parts) -> Result<Self, Refusal> {
        let varied = parts.albedo.and_then(|albedo| problem.with_albedo(albedo));
        let problem = varied.map_or_else(|| problem.clone(), Arc::new);
        let distributions = parts.distributions;
        let fields = P::Fields::new(&problem, parts)?;
        Ok(Self { problem, fields, distributions })
    }
}

/// Medium of a channel, cut into panels, and its σ̂ along the ray; `None` for estimators that take none.
pub type ChannelPart = (Arc<Mesh>, Option<Piecewise>);

/// Function that makes σ̂ in a volume, for particles that leave the ray.
pub type SpaceSampling<'a> = Box<dyn FnOnce(&Volume) -> Result<Space, Refusal> + 'a>;

/// Parts from which the fields of a setup are made.
pub struct Parts<'a> {
    /// Medium and σ̂ of each channel along the ray; at least one.
    pub channels: Vec<ChannelPart>,
    /// σ_c.
    pub control: Control,
    /// σ̂ in space.
    pub space: SpaceSampling<'a>,
    /// The swept albedo, in place of the one in the case.
    pub albedo: Option<f64>,
    /// See [`Setup::distributions`].
    pub distributions: bool,
}

/// Fields that all estimators of a problem `P` work on.
pub trait Fields<P>: Sized + Send + Sync + 'static {
    /// Joins the parts; σ̂ is restricted to the support of the medium.
    ///
    /// # Errors
    ///
    /// σ̂ that the problem cannot use.
    fn new(problem: &P, parts: Parts) -> Result<Self, Refusal>;

    /// Sets σ̂ to 0 where collisions would change nothing but the cost.
    #[must_use]
    fn skipping(self) -> Self {
        self
    }

    /// Share of the ray's support on which σ̂ is 0 because the residual is; in space, share of the box about the
    /// volume.
    fn skipped(&self) -> f64 {
        0.0
    }

    /// Requires first weights of walks that doubles hold.
    ///
    /// # Errors
    ///
    /// The weight.
    fn require_weights(&self) -> Result<(), Refusal> {
        Ok(())
    }
}

/// σ̂ in space, for particles that leave the ray.
pub type Space = Arc<Majorants>;

impl<P: Walked> Fields<P> for Space {
    fn new(problem: &P, parts: Parts) -> Result<Self, Refusal> {
        (parts.space)(&*problem.scene().volume)
    }

    fn skipped(&self) -> f64 {
        self.empty_share()
    }
}

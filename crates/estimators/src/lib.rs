//! Estimators, one page each: how a draw is made, and its prediction by theory.
//!
//! An estimator is data. What it works on (medium, σ̂, control) is prepared once in a [`Setup`];
//! its loop is compiled once per field type and entered once per buffer of draws. Estimators of
//! one problem form one folder and one list; the recipes for σ̂ and for the control have theirs.

pub mod bidirectional_rod;
pub mod chromatic;
pub mod chromatic_slab;
pub mod draw;
pub mod free_flight;
pub mod furnace;
pub mod infinite_medium;
pub mod lambertian;
pub mod lit_rod;
pub mod lit_slab;
pub mod multiple_scattering;
pub mod own;
pub mod recipes;
pub mod rod;
pub mod setup;
pub mod single_scattering;
pub mod slab;
pub mod space;
pub mod spectral_furnace;
pub mod spectral_lit_rod;
pub mod spectral_rod;
pub mod spectral_single_scattering;
pub mod spectral_slab;
pub mod spectral_transmittance;
pub mod sphere;
pub mod traits;
pub mod transmittance;
pub mod transmittance_curve;
pub mod trial;
pub mod walks;

use media::catalogue::{Page, Registry, Settings};
use numeric::rng::Address;
use theory::Prediction;
use theory::problems::{Named, ProblemOption, each_problem};

pub use crate::recipes::{Refusal, Site};
pub use crate::setup::{Fields, Setup};

pub use crate::draw::{Draw, DrawBuffer, Request};
pub use crate::own::EstimatorReader;
pub use traits::{Inputs, Knowledge, Traits};
pub use transmittance_curve::RayView;
pub use trial::{Experiment, Kernel};

/// A page of the catalogue of estimators of problem `P`.
pub trait Estimator<P: Estimated>: Clone + Send + Sync + 'static {
    /// Inputs of the estimator, unless its settings say otherwise.
    const INPUTS: Inputs;
    /// The estimator, if it has no settings.
    const PLAIN: Option<Self> = None;

    /// Reads its own settings from `NAME = { … }`; the caller reads `sampling`, `control` and `expect`.
    fn read(settings: &Settings) -> Option<Self> {
        let _ = settings;
        Self::PLAIN
    }

    /// Returns its properties with its own settings.
    fn traits(&self) -> Traits {
        Traits::of(Self::INPUTS)
    }

    /// Returns the estimator with another albedo; `None` if it has no albedo.
    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        let _ = albedo;
        None
    }

    /// Checks that the estimator exists and is unbiased on a setup, mostly by the `require_…` functions of
    /// `setup.residual()` and `setup.fields`.
    ///
    /// # Errors
    ///
    /// The violated inequality and where on the ray.
    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal>;

    /// Returns the prediction for a draw.
    fn predict(&self, setup: &Setup<P>) -> Prediction;

    /// The ray seen from the side, for estimators of a curve.
    fn ray_view(&self, setup: &Setup<P>, address: Address) -> Option<RayView> {
        let _ = (setup, address);
        None
    }

    /// Makes the draws of a request: bit for bit equal for every kernel and level.
    ///
    /// Draw j comes from stream j mod 16. [`walks::fill`] makes them of a walk, [`walks::one_by_one`] of a function.
    ///
    /// # Panics
    ///
    /// On processors that lack what kernels are compiled for, see [`numeric::fused::missing`].
    fn fill(&self, kernel: Kernel, setup: &Setup<P>, request: Request);
}

/// A problem with a catalogue of estimators.
pub trait Estimated: Named {
    /// Fields that the estimators work on.
    type Fields: Fields<Self>;

    /// The estimators of this problem.
    const CATALOGUE: &'static Registry<EstimatorReader<Self>>;
}

/// The estimators of one form of a problem.
#[derive(Debug, Clone)]
pub struct FormCatalogue {
    /// Name of the problem.
    pub problem: String,
    /// Options that choose the form.
    pub options: &'static [ProblemOption],
    /// Name of the form, such as `rod with light`.
    pub title: String,
    /// The estimators.
    pub pages: &'static [Page],
}

impl FormCatalogue {
    fn of<P: Estimated>() -> Self {
        let (problem, pages) = (P::MODULE.replace('_', "-"), P::CATALOGUE.pages);
        Self { problem, options: P::OPTIONS, title: P::title(), pages }
    }
}

/// The estimators of every problem, form by form, in the order of the problems.
pub fn catalogues() -> Vec<FormCatalogue> {
    each_problem!(FormCatalogue::of).into_iter().flatten().collect()
}

/// Implements [`Estimated`] for a form of a problem by its fields and the [`registry!`](media::registry) of its estimators.
macro_rules! estimators {
    ($Problem:ident on $Fields:ident: $($pages:tt)+) => {
        impl $crate::Estimated for $Problem {
            type Fields = $crate::setup::$Fields;

            const CATALOGUE: &'static media::catalogue::Registry<$crate::EstimatorReader<Self>> = {
                use $crate::EstimatorReader;
                static CATALOGUE: media::catalogue::Registry<EstimatorReader<$Problem>> =
                    media::registry![EstimatorReader of $($pages)+];
                &CATALOGUE
            };
        }
    };
}
use estimators;

/// Implements the draws of a product estimator of transmittance by its rule at a collision, as in
/// `product_draws!(self => self.rule)`.
macro_rules! product_draws {
    ($this:ident => $rule:expr) => {
        fn fill(
            &$this,
            kernel: $crate::Kernel,
            setup: &$crate::Setup<Transmittance>,
            request: $crate::Request,
        ) {
            $crate::transmittance::product::fill(kernel, setup, &$rule, request);
        }
    };
}
use product_draws;

/// Implements a next-flight estimator for a page that implements [`scoring::Share`] and theory's moments, as in
/// `scored!(NextFlight)`.
macro_rules! scored {
    ($Page:ident) => {
        impl $crate::Estimator<Transmittance> for $Page {
            const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;
            const PLAIN: Option<Self> = Some(Self);

            fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), $crate::Refusal> {
                setup
                    .fields
                    .require_plain_unit("τ ≤ 300 (its draws are sums of terms of every size)")?;
                setup.residual().require_constant_sampling()?;
                setup.fields.require_finite_weights(&theory::collisions::rules::Weight)
            }

            fn predict(&self, setup: &Setup<Transmittance>) -> theory::Prediction {
                let sampling = setup.fields.sampling.single_value().unwrap_or(0.0);
                theory::ray::volterra::predict(&setup.fields.mesh, sampling, self)
            }

            fn fill(
                &self,
                kernel: $crate::Kernel,
                setup: &Setup<Transmittance>,
                request: $crate::Request,
            ) {
                let walk = $crate::transmittance::scoring::Scoring::new(Self, setup);
                $crate::walks::fill(&walk, kernel, setup, request);
            }
        }
    };
}
use scored;

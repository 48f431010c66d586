//! Known bugs: a twin of an estimator with one mistake in it, for a gate that must not let it pass.
//!
//! A test that has never failed proves little. A mutant names one experiment of the built-in suite
//! and the check that must catch it there; `trueflight self-test` draws it in the honest
//! estimator's place, against the honest estimator's prediction.
//!
//! A mutant's walk is [`walk`] with one [`Fault`]: the steps of a correct walk are [`RIGHT`], and a
//! fault replaces one of them. Without a fault the walk is the estimator's
//! own, bit for bit; that *honest twin* shows that nothing but the bug was changed. One file holds
//! one family of bugs; a mutant is one entry in its family's list. Wrong [`streams`] are a family
//! of their own: there the estimators are right and their random numbers are not.
//!
//! The bugs are those that renderers and transport codes have had, and those that a formula of this
//! crate invites.

pub mod bidirectional_rod;
mod caught;
pub mod chromatic_slab;
pub mod control;
pub mod curve;
pub mod decisions;
pub mod fault;
pub mod flight;
pub mod free_flight;
pub mod lit_rod;
pub mod lit_slab;
pub mod lookups;
pub mod null_paths;
pub mod precision;
pub mod rod;
pub mod rules;
pub mod scores;
pub mod single_scattering;
pub mod slab;
pub mod space;
pub mod spectral;
pub mod spectral_furnace;
pub mod spectral_lit_rod;
pub mod spectral_rod;
pub mod spectral_single_scattering;
pub mod sphere;
pub mod sphere_paths;
pub mod streams;
pub mod target;
pub mod tracking;
pub mod trial;
pub mod walk;
pub mod weights;

use std::any::Any;
use std::sync::Arc;

use estimators::{Draw, Experiment, Kernel, Request, Setup, walks};
use media::Lookups;
use numeric::rng::Stream;
use theory::problems::Problem;

pub use caught::Caught;
pub use fault::{Fault, RIGHT};
pub use streams::StreamMutant;
pub use target::Target;
pub use trial::{Draws, Trial};

/// Description of a mutant, without its draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct About {
    /// The name, unique among all mutants.
    pub name: &'static str,
    /// The bug in one sentence.
    pub bug: &'static str,
    /// The experiment that shows it.
    pub target: Target,
    /// The check that must catch it there.
    pub check: &'static str,
}

/// A known bug in an estimator of problem `P`.
pub struct Mutant<P: Problem> {
    /// Description.
    pub about: About,
    faulty: Arc<Draws<P>>,
    honest: Arc<Draws<P>>,
    fault: Fault,
}

impl<P: Problem> Mutant<P> {
    /// Joins a bug and the same draws without it.
    pub fn new(
        about: About,
        faulty: impl Fn(Kernel, &Setup<P>, Request) + Send + Sync + 'static,
        honest: impl Fn(Kernel, &Setup<P>, Request) + Send + Sync + 'static,
    ) -> Self {
        Self { about, faulty: Arc::new(faulty), honest: Arc::new(honest), fault: RIGHT }
    }

    /// Applies a fault to the setup and the generator of the mutant.
    #[must_use]
    pub fn on_faulty_setup(self, fault: Fault) -> Self {
        Self { fault, ..self }
    }

    /// The experiment of a walk on a prepared `Setup<P>`; `None` for the setup of another problem.
    fn drawn(&self, walk: Walk, setup: Box<dyn Any>) -> Option<Box<dyn Experiment>> {
        let setup = *setup.downcast::<Setup<P>>().ok()?;
        Some(match walk {
            Walk::Faulty => self.experiment(setup),
            Walk::Twin => self.twin(setup),
        })
    }

    /// The experiment with the bug.
    pub fn experiment(&self, setup: Setup<P>) -> Box<dyn Experiment> {
        let (setup, replays) = (self.fault.prepared(setup), self.fault.replays);
        Box::new(Trial { draws: self.faulty.clone(), setup, replays })
    }

    /// The honest twin: the same code without the bug.
    pub fn twin(&self, setup: Setup<P>) -> Box<dyn Experiment> {
        Box::new(Trial { draws: self.honest.clone(), setup, replays: false })
    }
}

/// Draws one by one, by a way to make one, right or wrong.
fn with<P: Problem, B: Send + Sync + 'static>(
    bug: B,
    draw: impl Fn(&B, &Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static,
) -> impl Fn(Kernel, &Setup<P>, Request) + Send + Sync + 'static {
    move |_, setup, request| {
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |medium, random| draw(&bug, setup, medium, random),
        );
    }
}

/// Draws of a walk whose steps are right or wrong, by any kernel.
fn filled<P: Problem, B: Copy + Send + Sync + 'static>(
    steps: B,
    fill: impl Fn(B, Kernel, &Setup<P>, Request) + Send + Sync + 'static,
) -> impl Fn(Kernel, &Setup<P>, Request) + Send + Sync + 'static {
    move |kernel, setup, request| fill(steps, kernel, setup, request)
}

/// One of a mutant's two walks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
    /// The one with the bug.
    Faulty,
    /// The code without the bug.
    Twin,
}

macro_rules! families {
    ($($family:expr,)*) => {
        /// Every mutant of every problem, without the wrong streams.
        pub fn all() -> Vec<About> {
            let mut all = Vec::new();
            $(all.extend($family.into_iter().map(|mutant| mutant.about));)*
            all
        }

        /// Makes the experiment of a mutant on the prepared `Setup<P>` of its problem; `None` if no mutant has that
        /// name, or if the setup is of another problem.
        pub fn experiment(
            name: &str,
            walk: Walk,
            setup: Box<dyn Any>,
        ) -> Option<Box<dyn Experiment>> {
            $(if let Some(mutant) = $family.into_iter().find(|own| own.about.name == name) {
                return mutant.drawn(walk, setup);
            })*
            None
        }
    };
}

families! {
    control::mutants(),
    lookups::mutants(),
    flight::mutants(),
    weights::mutants(),
    rules::mutants(),
    decisions::mutants(),
    scores::mutants(),
    tracking::mutants(),
    precision::mutants(),
    free_flight::mutants(),
    precision::flights(),
    curve::mutants(),
    spectral::mutants(),
    rod::mutants(),
    spectral_rod::mutants(),
    lit_rod::mutants(),
    lit_slab::mutants(),
    spectral_lit_rod::mutants(),
    slab::mutants(),
    spectral_rod::in_slab(),
    chromatic_slab::mutants(),
    single_scattering::mutants(),
    null_paths::mutants(),
    spectral_single_scattering::mutants(),
    space::in_furnace(),
    spectral_furnace::mutants(),
    space::under_light(),
    space::in_infinite_medium(),
    sphere::mutants(),
    sphere_paths::mutants(),
    bidirectional_rod::mutants(),
}

/// Returns the names of the checks that some mutant must be caught by.
pub fn named_checks() -> Vec<&'static str> {
    let estimators = all().into_iter().map(|about| about.check);
    let mut names: Vec<_> =
        estimators.chain(streams::MUTANTS.iter().map(|mutant| mutant.check)).collect();
    names.sort_unstable();
    names.dedup();
    names
}

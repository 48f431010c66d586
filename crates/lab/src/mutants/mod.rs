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

use estimators::{Draw, Estimated, Experiment, Setup};
use media::Lookups;
use numeric::pack::in_fused_code;
use numeric::rng::Stream;
use theory::problems::{
    BidirectionalRod, ChromaticSlab, FreeFlight, Furnace, InfiniteMedium, Lambertian, LitRod,
    LitSlab, Problem, Rod, SingleScattering, Slab, SpectralFurnace, SpectralLitRod, SpectralRod,
    SpectralSingleScattering, SpectralSlab, SpectralTransmittance, Sphere, Transmittance,
    TransmittanceCurve, each_problem,
};

pub use caught::Caught;
pub use fault::{Fault, RIGHT};
pub use streams::StreamMutant;
pub use target::Target;
pub use trial::{Draws, Trial};

/// What a mutant is, without its draws.
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
    /// What it is.
    pub about: About,
    faulty: Arc<Draws<P>>,
    honest: Arc<Draws<P>>,
    fault: Fault,
}

impl<P: Problem> Mutant<P> {
    /// Joins a bug and the same draws without it.
    pub fn new(
        about: About,
        faulty: impl Fn(&Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static,
        honest: impl Fn(&Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static,
    ) -> Self {
        Self { about, faulty: compiled(faulty), honest: compiled(honest), fault: RIGHT }
    }

    /// The same on a setup and a generator that a fault makes wrong.
    #[must_use]
    pub fn on_faulty_setup(self, fault: Fault) -> Self {
        Self { fault, ..self }
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

/// Draws by a way to make them, right or wrong.
fn with<P: Problem, B: Send + Sync + 'static>(
    bug: B,
    draw: impl Fn(&B, &Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static,
) -> impl Fn(&Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static {
    move |setup, medium, rng| draw(&bug, setup, medium, rng)
}

fn compiled<P: Problem>(
    draw: impl Fn(&Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static,
) -> Arc<Draws<P>> {
    Arc::new(move |setup: &Setup<P>, medium: &Lookups<'_>, rng: &mut Stream| {
        in_fused_code(
            #[inline(always)]
            || draw(setup, medium, rng),
        )
    })
}

/// A problem with known bugs.
pub trait Mutable: Estimated {
    /// Every mutant, family by family.
    fn mutants() -> Vec<Mutant<Self>>;
}

macro_rules! mutable {
    ($($Problem:ident: $($family:expr),*;)*) => {
        $(
            impl Mutable for $Problem {
                fn mutants() -> Vec<Mutant<Self>> {
                    [$($family),*].into_iter().flatten().collect()
                }
            }
        )*
    };
}

mutable! {
    Transmittance: control::mutants(), lookups::mutants(), flight::mutants(), weights::mutants(),
        rules::mutants(), decisions::mutants(), scores::mutants(), tracking::mutants(),
        precision::mutants();
    FreeFlight: free_flight::mutants(), precision::flights();
    TransmittanceCurve: curve::mutants();
    SpectralTransmittance: spectral::mutants();
    SpectralRod: spectral_rod::mutants();
    Rod: rod::mutants();
    LitRod: lit_rod::mutants();
    LitSlab: lit_slab::mutants();
    SpectralLitRod: spectral_lit_rod::mutants();
    SingleScattering: single_scattering::mutants(), null_paths::mutants();
    SpectralSingleScattering: spectral_single_scattering::mutants();
    Furnace: space::in_furnace();
    SpectralFurnace: spectral_furnace::mutants();
    Lambertian: space::under_light();
    InfiniteMedium: space::in_infinite_medium();
    Slab: slab::mutants();
    SpectralSlab: spectral_rod::in_slab();
    ChromaticSlab: chromatic_slab::mutants();
    Sphere: sphere::mutants(), sphere_paths::mutants();
    BidirectionalRod: bidirectional_rod::mutants();
}

/// Which of a mutant's two walks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
    /// The one with the bug.
    Faulty,
    /// The code without the bug.
    Twin,
}

/// Makes the experiment of a mutant on a prepared `Setup<P>`; `None` if problem `P` has no mutant of that name.
pub fn experiment(name: &str, walk: Walk, setup: Box<dyn Any>) -> Option<Box<dyn Experiment>> {
    type Made = Result<Option<Box<dyn Experiment>>, Box<dyn Any>>;
    fn on<P: Mutable>(name: &str, walk: Walk, setup: Box<dyn Any>) -> Made {
        let setup = *setup.downcast::<Setup<P>>()?;
        let mutant = P::mutants().into_iter().find(|mutant| mutant.about.name == name);
        Ok(mutant.map(|mutant| match walk {
            Walk::Faulty => mutant.experiment(setup),
            Walk::Twin => mutant.twin(setup),
        }))
    }
    macro_rules! on_each {
        ($($module:ident :: $Problem:ident,)*) => {
            [$(on::<theory::problems::$Problem>),*]
        };
    }
    let mut setup = setup;
    for on in each_problem!(on_each) {
        match on(name, walk, setup) {
            Ok(made) => return made,
            Err(other) => setup = other,
        }
    }
    None
}

/// Every mutant of every problem, without the wrong streams.
pub fn all() -> Vec<About> {
    fn about<P: Mutable>() -> Vec<About> {
        P::mutants().into_iter().map(|mutant| mutant.about).collect()
    }
    macro_rules! of_all {
        ($($module:ident :: $Problem:ident,)*) => {
            [$(about::<theory::problems::$Problem>),*]
        };
    }
    each_problem!(of_all).into_iter().flat_map(|about| about()).collect()
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

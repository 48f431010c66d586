//! Known bugs: an estimator with one mistake in it, for a gate that must not let it pass.
//!
//! A test that has never failed proves little. A mutant names one experiment of the built-in suite
//! and the check that must catch it there; `trueflight self-test` draws it in the place
//! of the correct estimator, against its prediction.
//!
//! A mutant is a walk of the estimators with other steps, other random numbers, or another setup. Without its bug
//! the walk makes the estimator's own draws, bit for bit. That control, its *twin*, shows that only the bug was
//! changed. One file holds one family of bugs, and a mutant is one line of its family's table. Bugs along a ray are
//! in [`line`], a wrapper of walks. Wrong [`streams`] are a family of their own: correct estimators with wrong random
//! numbers.
//!
//! The bugs are those that renderers and transport codes have had, and those that a formula of this
//! project invites.

mod bidirectional_rod;
mod caught;
mod chromatic;
mod curve;
mod free_flight;
mod line;
mod lit_rod;
mod lit_slab;
mod particle;
mod product;
mod rule;
mod scores;
mod single_scattering;
mod spectral;
mod spectral_lit_rod;
mod spectral_rod;
mod spectral_single_scattering;
mod sphere;
pub mod streams;
mod tracking;
mod trial;

use std::any::Any;
use std::sync::Arc;

use estimators::{Draw, Estimated, Experiment, Request, Setup, walks};
use media::Lookups;
use numeric::rng::Stream;

pub use caught::Caught;
pub use streams::StreamMutant;
use trial::{Draws, Trial};

/// One experiment of a case of the built-in suite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// The case.
    pub case: &'static str,
    /// Index of the estimator in the case, from 0.
    pub index: usize,
    /// Point of the sweep, in cases that have one.
    pub swept: Option<f64>,
}

/// An estimator of a case without a sweep.
const fn on(case: &'static str, index: usize) -> Target {
    Target { case, index, swept: None }
}

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

/// A mutant in the table of its family: name, bug in one sentence, target, check, and the bug itself.
type Line<B> = (&'static str, &'static str, Target, &'static str, B);

/// A known bug in an estimator of problem `P`.
struct Mutant<P: Estimated> {
    about: About,
    faulty: Arc<Draws<P>>,
    honest: Arc<Draws<P>>,
    /// Changes the setup to a wrong one.
    prepare: fn(&mut Setup<P>),
    /// True if every 1024 draws begin with the same random numbers.
    replays: bool,
}

impl<P: Estimated> Mutant<P> {
    /// The experiment of a walk on a prepared `Setup<P>`; `None` for the setup of another problem.
    fn experiment(&self, walk: Walk, setup: Box<dyn Any>) -> Option<Box<dyn Experiment>> {
        let mut setup = *setup.downcast::<Setup<P>>().ok()?;
        let trial = match walk {
            Walk::Faulty => {
                (self.prepare)(&mut setup);
                Trial { draws: self.faulty.clone(), setup, replays: self.replays }
            }
            Walk::Twin => Trial { draws: self.honest.clone(), setup, replays: false },
        };
        Some(Box::new(trial))
    }
}

/// Mutants of a table. A bug and its control, with `right` in place of the bug, run the same code.
fn family<P: Estimated, B, D>(
    lines: &[Line<B>],
    right: &B,
    draws: impl Fn(Target, &B) -> D,
) -> Vec<Mutant<P>>
where
    D: Fn(&Setup<P>, Request) + Send + Sync + 'static,
{
    let mutant = |(name, bug, target, check, wrong): &Line<B>| Mutant {
        about: About { name, bug, target: *target, check },
        faulty: Arc::new(draws(*target, wrong)) as Arc<Draws<P>>,
        honest: Arc::new(draws(*target, right)),
        prepare: |_| {},
        replays: false,
    };
    lines.iter().map(mutant).collect()
}

/// Fixes the type of a function that makes all draws of a request.
fn filled<P: Estimated>(
    fill: impl Fn(&Setup<P>, Request) + Send + Sync + 'static,
) -> impl Fn(&Setup<P>, Request) + Send + Sync + 'static {
    fill
}

/// Makes the draws of requests one by one, by a function with right or wrong steps.
fn with<P: Estimated, S: Send + Sync + 'static>(
    steps: S,
    draw: impl Fn(&S, &Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static,
) -> impl Fn(&Setup<P>, Request) + Send + Sync + 'static {
    move |setup, request| {
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |medium, random| draw(&steps, setup, medium, random),
        );
    }
}

/// One of a mutant's two walks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
    /// The walk with the bug.
    Faulty,
    /// The control: the code without the bug.
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
                return mutant.experiment(walk, setup);
            })*
            None
        }
    };
}

families! {
    product::mutants(),
    scores::mutants(),
    tracking::mutants(),
    free_flight::mutants(),
    curve::mutants(),
    spectral::mutants(),
    particle::in_rod(),
    spectral_rod::in_rod(),
    lit_rod::mutants(),
    lit_slab::mutants(),
    spectral_lit_rod::mutants(),
    particle::in_slab(),
    spectral_rod::in_slab(),
    chromatic::in_slab(),
    single_scattering::mutants(),
    spectral_single_scattering::mutants(),
    particle::in_furnace(),
    chromatic::in_furnace(),
    particle::under_light(),
    particle::in_infinite_medium(),
    sphere::mutants(),
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

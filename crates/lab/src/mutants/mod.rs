//! Known bugs: an estimator with one mistake in it, for a gate that must not let it pass.
//!
//! A test that has never failed proves little. A mutant names one experiment of the built-in suite
//! and the check that must catch it there; `trueflight-lab self-test` draws it in the place
//! of the correct estimator, against its prediction.
//!
//! A mutant is a walk of the estimators with other steps, other random numbers, or another setup. Without its bug
//! the walk makes the estimator's own draws, bit for bit. That control, its *twin*, shows that only the bug was
//! changed. One file holds one family of bugs, and a mutant is one line of its family's table: its name, the bug in a
//! sentence, where the bug is caught and by which check, and the wrong code. Bugs along a ray are changes of a number
//! in the loop of one walk ([`line`]). Other walks have a walk around them that changes a step (`altered`). Wrong
//! [`streams`] are a family of their own: correct estimators with wrong random numbers.
//!
//! The bugs are those that renderers and transport codes have had, and those that a formula of this
//! project invites.

mod altered;
mod bidirectional_rod;
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

use gate::CheckId;
use std::any::Any;
use std::sync::Arc;

use estimators::{Draw, DrawBuffer, Estimated, Experiment, Kernel, Request, Setup, walks};
use media::Lookups;
use media::catalogue::Page;
use numeric::rng::{Stream, Streams};

pub use streams::StreamMutant;

/// One experiment of a case of the built-in suite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MutantTarget {
    /// The case.
    pub case: &'static str,
    /// Index of the estimator in the case, from 0.
    pub index: usize,
    /// Point of the sweep, in cases that have one.
    pub swept: Option<f64>,
}

/// Description of a mutant, without its draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct About {
    /// The name, unique among all mutants.
    pub name: &'static str,
    /// The bug in one sentence.
    pub bug: &'static str,
    /// The experiment that shows it.
    pub target: MutantTarget,
    /// The check that must catch it there.
    pub check: CheckId,
}

/// Result of drawing one mutant in the place of its estimator.
#[derive(Debug, Clone)]
pub struct Caught {
    /// Name of the mutant.
    pub name: &'static str,
    /// The bug in one sentence.
    pub bug: &'static str,
    /// The case.
    pub case: &'static str,
    /// The estimator that the mutant replaces.
    pub estimator: String,
    /// The check that must catch it.
    pub check: CheckId,
    /// The draws that the check took; `None` if it did not catch the bug.
    pub draws: Option<u64>,
    /// All checks that failed.
    pub failed: Vec<CheckId>,
    /// True if the control passed: the code without the bug.
    pub twin_passes: bool,
}

impl Caught {
    /// Returns whether the bug was caught and its control passed.
    pub fn is_right(&self) -> bool {
        self.draws.is_some() && self.twin_passes
    }
}

/// An experiment of the built-in suite, with the settings of the estimator that is drawn there.
#[derive(Clone, Copy)]
struct On<E> {
    target: MutantTarget,
    estimator: E,
}

/// An estimator of a case without a sweep.
const fn on<E: Copy>(case: &'static str, index: usize, estimator: E) -> On<E> {
    On { target: MutantTarget { case, index, swept: None }, estimator }
}

impl<E: Copy> On<E> {
    /// The point of a sweep.
    const fn swept(self, value: f64) -> Self {
        On { target: MutantTarget { swept: Some(value), ..self.target }, ..self }
    }
}

/// A mutant in the table of its family: name, bug in one sentence, target, check, and the bug itself.
type MutantRow<E, B> = (&'static str, &'static str, On<E>, CheckId, B);

/// Function that makes the draws of a request, with or without a bug.
type DrawFunction<P> = dyn Fn(&Setup<P>, Request) + Send + Sync;

/// A known bug in an estimator of problem `P`.
struct Mutant<P: Estimated> {
    about: About,
    faulty: Arc<DrawFunction<P>>,
    control: Arc<DrawFunction<P>>,
    /// Changes the setup to a wrong one.
    prepare: fn(&mut Setup<P>),
}

impl<P: Estimated> Mutant<P> {
    /// The experiment of a walk on a prepared `Setup<P>`; `None` for the setup of another problem.
    fn experiment(&self, walk: MutantWalk, setup: Box<dyn Any>) -> Option<Box<dyn Experiment>> {
        let mut setup = *setup.downcast::<Setup<P>>().ok()?;
        if walk == MutantWalk::Control {
            return Some(Box::new(MutantExperiment { draws: self.control.clone(), setup }));
        }
        (self.prepare)(&mut setup);
        Some(Box::new(MutantExperiment { draws: self.faulty.clone(), setup }))
    }
}

/// Draws on a setup.
struct MutantExperiment<P: Estimated> {
    draws: Arc<DrawFunction<P>>,
    setup: Setup<P>,
}

impl<P: Estimated> Experiment for MutantExperiment<P> {
    fn fill_by(&self, _: Kernel, streams: &mut Streams, count: usize, buffer: &mut DrawBuffer) {
        (self.draws)(&self.setup, Request { streams, count, buffer });
    }
}

/// Mutants of a table. A bug and its control, with `right` in place of the bug, run the same code.
fn family<P: Estimated, E, B, D>(
    lines: &[MutantRow<E, B>],
    right: &B,
    draws: impl Fn(&E, &B) -> D,
) -> Vec<Mutant<P>>
where
    D: Fn(&Setup<P>, Request) + Send + Sync + 'static,
{
    let mutant = |(name, bug, on, check, wrong): &MutantRow<E, B>| Mutant {
        about: About { name, bug, target: on.target, check: *check },
        faulty: Arc::new(draws(&on.estimator, wrong)) as Arc<DrawFunction<P>>,
        control: Arc::new(draws(&on.estimator, right)),
        prepare: |_| {},
    };
    lines.iter().map(mutant).collect()
}

/// Fixes the type of a function that makes all draws of a request.
fn filled<P: Estimated>(
    fill: impl Fn(&Setup<P>, Request) + Send + Sync + 'static,
) -> impl Fn(&Setup<P>, Request) + Send + Sync + 'static {
    fill
}

/// Makes the draws of requests one by one.
fn one_by_one<P: Estimated>(
    draw: impl Fn(&Setup<P>, &Lookups, &mut Stream) -> Draw<P::Value> + Send + Sync + 'static,
) -> impl Fn(&Setup<P>, Request) + Send + Sync + 'static {
    move |setup, request| {
        walks::one_by_one(
            setup,
            request,
            #[inline(always)]
            |medium, random| draw(setup, medium, random),
        );
    }
}

/// One of a mutant's two walks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MutantWalk {
    /// The walk with the bug.
    Faulty,
    /// The control: the code without the bug.
    Control,
}

/// Lists the families. The mutants of each have the type of their problem, so that no array can hold them.
macro_rules! families {
    ($($module:ident::$mutants:ident,)*) => {
        /// Every family: its page, and its mutants. Wrong streams come last.
        pub fn families() -> Vec<(Page, Vec<About>)> {
            let about = |mutant: &StreamMutant| mutant.about();
            vec![
                $((media::page!($module), abouts($module::$mutants())),)*
                (media::page!(streams), streams::MUTANTS.iter().map(about).collect()),
            ]
        }

        /// Every mutant of every problem, without the wrong streams.
        pub fn all() -> Vec<About> {
            [$(abouts($module::$mutants())),*].concat()
        }

        /// Makes the experiment of a mutant on the prepared `Setup<P>` of its problem; `None` if no mutant has that
        /// name, or if the setup is of another problem.
        pub fn experiment(
            name: &str,
            walk: MutantWalk,
            setup: Box<dyn Any>,
        ) -> Option<Box<dyn Experiment>> {
            $(if let Some(mutant) = $module::$mutants().iter().find(|own| own.about.name == name) {
                return mutant.experiment(walk, setup);
            })*
            None
        }
    };
}

fn abouts<P: Estimated>(mutants: Vec<Mutant<P>>) -> Vec<About> {
    mutants.into_iter().map(|mutant| mutant.about).collect()
}

families! {
    product::mutants,
    scores::mutants,
    free_flight::mutants,
    curve::mutants,
    spectral::mutants,
    particle::in_rod,
    spectral_rod::in_rod,
    lit_rod::mutants,
    lit_slab::mutants,
    spectral_lit_rod::mutants,
    particle::in_slab,
    spectral_rod::in_slab,
    chromatic::in_slab,
    single_scattering::mutants,
    spectral_single_scattering::mutants,
    particle::in_furnace,
    chromatic::in_furnace,
    particle::under_light,
    particle::in_infinite_medium,
    sphere::mutants,
    bidirectional_rod::mutants,
}

/// Returns the checks that some mutant must be caught by.
pub fn named_checks() -> Vec<CheckId> {
    let abouts = families().into_iter().flat_map(|(_, abouts)| abouts);
    let mut names: Vec<_> = abouts.map(|about| about.check).collect();
    names.sort_unstable();
    names.dedup();
    names
}

//! Walks through a rod of coloured scatterers, all channels by one draw.

pub mod hero;
pub mod independent;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use crate::{Refusal, Setup, estimators};
use theory::problems::spectral_rod::{Colours, Values};
use theory::problems::{Problem, SpectralRod};
use theory::spectral_rod::{Body, Rods, Spectrum, Tracker};

/// A body of coloured scatterers: the pages of its estimators are the same.
pub trait Coloured: Problem<Value = Values> {
    /// Its albedos.
    fn colours(&self) -> &Colours;

    /// Whether theory knows the body.
    ///
    /// # Errors
    ///
    /// Why not.
    fn require_answer(setup: &Setup<Self>) -> Result<(), Refusal>;

    /// What theory knows of it.
    fn body(setup: &Setup<Self>) -> Box<dyn Body + '_>;

    /// The place of walks.
    fn place(&self) -> walk::Place<'_>;
}

impl Coloured for SpectralRod {
    fn colours(&self) -> &Colours {
        &self.colours
    }

    fn require_answer(_: &Setup<Self>) -> Result<(), Refusal> {
        Ok(())
    }

    fn body(setup: &Setup<Self>) -> Box<dyn Body + '_> {
        Box::new(Rods::new(&setup.problem, &setup.mesh, &setup.sampling))
    }

    fn place(&self) -> walk::Place<'_> {
        walk::Place::Rod(self.forward)
    }
}

/// What theory says of a tracker.
fn spectrum<P: Coloured>(setup: &Setup<P>, heroes: Vec<f64>, tracker: Tracker) -> Spectrum<'_> {
    Spectrum::new(P::body(setup), setup.problem.colours(), heroes, tracker)
}

/// The draws of a page: all that differs are its [`walk::Page`].
macro_rules! scored {
    () => {
        const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;

        fn fill(&self, kernel: $crate::Kernel, setup: &$crate::Setup<P>, request: $crate::Request) {
            $crate::walks::by(
                kernel,
                setup,
                request,
                |level, medium, request| {
                    $crate::spectral_rod::walk::packets(level, self, setup, medium, request)
                },
                #[inline(always)]
                |medium, rng| $crate::spectral_rod::walk::draw(self, setup, medium, rng),
            );
        }
    };
}
use scored;

estimators! {
    SpectralRod:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
}

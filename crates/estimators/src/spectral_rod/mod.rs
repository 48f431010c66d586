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

/// A body of coloured scatterers; its estimators have common pages.
pub trait Coloured: Problem<Value = Values> {
    /// Albedos of the channels.
    fn colours(&self) -> &Colours;

    /// Checks that theory covers the body.
    ///
    /// # Errors
    ///
    /// The reason why not.
    fn require_answer(setup: &Setup<Self>) -> Result<(), Refusal>;

    /// The body as theory describes it.
    fn body(setup: &Setup<Self>) -> Box<dyn Body + '_>;

    /// Geometry of the walks.
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

/// Theory's description of a tracker.
fn spectrum<P: Coloured>(setup: &Setup<P>, heroes: Vec<f64>, tracker: Tracker) -> Spectrum<'_> {
    Spectrum::new(P::body(setup), setup.problem.colours(), heroes, tracker)
}

/// Implements the draws of a page that implements [`walk::Page`].
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

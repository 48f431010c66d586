//! Walks through a rod of coloured scatterers, all channels by one draw.

pub mod hero;
pub mod independent;
pub mod page;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use crate::setup::Line;
use crate::{Estimated, Refusal, Setup, estimators};
use theory::colours::scatterers::BodyEnergies;
use theory::problems::SpectralRod;
use theory::problems::channels::{ColourValues as Values, Colours};
use theory::rod::spectral::Rods;

/// A body of coloured scatterers; its estimators have one [`page`].
pub trait Coloured: Estimated<Value = Values, Fields = Line> {
    /// Albedos of the channels.
    fn colours(&self) -> &Colours;

    /// Checks that theory covers the body.
    ///
    /// # Errors
    ///
    /// The reason why not.
    fn require_answer(setup: &Setup<Self>) -> Result<(), Refusal>;

    /// The body as theory describes it.
    fn body(setup: &Setup<Self>) -> Box<dyn BodyEnergies + '_>;

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

    fn body(setup: &Setup<Self>) -> Box<dyn BodyEnergies + '_> {
        Box::new(Rods::new(&setup.problem, &setup.fields.mesh, &setup.fields.sampling))
    }

    fn place(&self) -> walk::Place<'_> {
        walk::Place::Rod(self.forward)
    }
}

estimators! {
    SpectralRod on Line:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
}

//! Walks through a slab of coloured scatterers, all channels by one draw.

pub mod hero;
pub mod independent;
pub mod spectral_mis;
pub mod spectral_tracking;

use super::slab::{in_channel, require_answer};
use super::spectral_rod::Coloured;
use super::spectral_rod::walk::Place;
use crate::{Refusal, Setup, estimators};
use ::theory::colours::scatterers::BodyEnergies;
use ::theory::problems::SpectralSlab;
use ::theory::problems::channels::Colours;
use ::theory::slab::chromatic::Slabs;

impl Coloured for SpectralSlab {
    fn colours(&self) -> &Colours {
        &self.colours
    }

    fn require_answer(setup: &Setup<Self>) -> Result<(), Refusal> {
        let (slab, depth) = (&setup.problem, setup.fields.mesh.optical_depth());
        slab.colours.seen.iter().try_for_each(|&(end, channel)| {
            let (albedo, place) = (slab.colours.albedos[channel], in_channel(channel));
            require_answer(&slab.incidence, depth, albedo, &[end], &place)
        })
    }

    fn body(setup: &Setup<Self>) -> Box<dyn BodyEnergies + '_> {
        let (incidence, with_distributions) = (setup.problem.incidence, setup.distributions);
        let (mesh, sampling) = (&*setup.fields.mesh, &setup.fields.sampling);
        Box::new(Slabs { incidence, mesh, sampling, with_distributions })
    }

    fn place(&self) -> Place<'_> {
        Place::Slab(&self.incidence)
    }
}

estimators! {
    SpectralSlab on Line:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
}

//! Walks through a slab of coloured scatterers, all channels by one draw.

pub mod hero;
pub mod independent;
pub mod spectral_mis;
pub mod spectral_tracking;

use super::spectral_rod::Coloured;
use super::spectral_rod::walk::Place;
use crate::{Refusal, Setup, estimators};
use ::theory::colours::scatterers::Body;
use ::theory::problems::SpectralSlab;
use ::theory::problems::channels::{Colours, End};
use ::theory::slab as theory;
use ::theory::slab::spectral::Slabs;
use numeric::digits::rounded;

impl Coloured for SpectralSlab {
    fn colours(&self) -> &Colours {
        &self.colours
    }

    fn require_answer(setup: &Setup<Self>) -> Result<(), Refusal> {
        let (phase, colours) = (&setup.problem.incidence.phase, &setup.problem.colours);
        let body = Self::body(setup);
        let is_sharp = |&(end, channel): &(End, usize)| {
            let found = body.leaving(colours.albedos[channel]);
            found.is_some_and(|found| theory::is_sharp(found[usize::from(end == End::Transmitted)]))
        };
        if theory::resolves(phase) && colours.seen.iter().all(is_sharp) {
            return Ok(());
        }
        let needs = "reflectances and transmittances that adding and doubling resolve to 1e-4 (above 1e-70, g ≥ −0.93)";
        let depth = rounded(setup.fields.mesh.optical_depth().value);
        Err(Refusal::mismatch(needs, format!("τ = {depth}, phase {}", phase.label())))
    }

    fn body(setup: &Setup<Self>) -> Box<dyn Body + '_> {
        let fields = (&*setup.fields.mesh, &setup.fields.sampling);
        Box::new(Slabs::new(&setup.problem, fields, setup.distributions))
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

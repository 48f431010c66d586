//! Walks through a slab in which every channel has a medium of its own, all of them by one draw.

pub mod independent;
pub mod packet;
pub mod page;
pub mod spectral_mis;
pub mod walk;

use crate::catalogue::rounded;
use crate::estimators::{Refusal, Setup, estimators};
use crate::problems::ChromaticSlab;
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::theory::chromatic_slab::Spectrum;

/// For theory.
fn spectrum(setup: &Setup<ChromaticSlab>) -> Spectrum<'_> {
    let media = setup.channels.iter().map(|channel| (&*channel.mesh, &channel.sampling));
    Spectrum::new(&setup.problem, media.collect(), setup.laws)
}

/// One hero probability and a constant σ̂ ≥ σ_t for each channel, and answers that theory resolves.
fn realisable(setup: &Setup<ChromaticSlab>, heroes: &Heroes) -> Result<(), Refusal> {
    heroes.require(setup.channels.len())?;
    channels::require_constants(&setup.channels)?;
    channels::require_majorants(&setup.channels)?;
    let Some(channel) = spectrum(setup).blurred() else { return Ok(()) };
    let needs = "reflectances and transmittances that adding and doubling resolve (|g| ≤ 0.93, a moderate τ)";
    let depth = rounded(setup.channels[channel].mesh.optical_depth().value);
    let phase = setup.problem.incidences[channel].phase.label();
    let found = format!("τ = {depth}, phase {phase} in channel {}", channel + 1);
    Err(Refusal::mismatch(needs, found))
}

estimators! {
    ChromaticSlab:
    independent::Independent,
    spectral_mis::SpectralMis,
}

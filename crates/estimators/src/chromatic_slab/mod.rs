//! Walks through a slab in which every channel has a medium of its own, all of them by one draw.

pub mod hero;
pub mod independent;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use self::walk::InSlab;
use super::chromatic::{Chromatic, WalkEvents, WalkerWeights};
use super::slab::{in_channel, require_answer};
use crate::setup::channels;
use crate::setup::walker::Walker;
use crate::walks::Walk;
use crate::{Refusal, Setup, estimators};
use media::Batches;
use theory::Prediction;
use theory::problems::ChromaticSlab;
use theory::slab::chromatic::SlabSpectrum;

/// The slab as theory describes it.
fn spectrum(setup: &Setup<ChromaticSlab>) -> SlabSpectrum<'_> {
    let media = setup.fields.iter().map(|channel| (&*channel.mesh, &channel.sampling));
    SlabSpectrum::new(&setup.problem, media.collect(), setup.distributions)
}

/// Checks that theory resolves the energies of all channels.
fn realisable(setup: &Setup<ChromaticSlab>) -> Result<(), Refusal> {
    let slab = &setup.problem;
    slab.colours.seen.iter().try_for_each(|&(end, channel)| {
        let depth = setup.fields[channel].mesh.optical_depth();
        let (albedo, place) = (slab.colours.albedos[channel], in_channel(channel));
        require_answer(&slab.incidences[channel], depth, albedo, &[end], &place)
    })
}

impl Chromatic for ChromaticSlab {
    #[inline(always)]
    fn walk<'a>(
        steps: impl WalkEvents,
        by: WalkerWeights<'a>,
        setup: &'a Setup<Self>,
        _: &'a [Batches<'a>],
    ) -> impl Walk {
        InSlab::new(steps, by, setup)
    }

    fn require(setup: &Setup<Self>, walker: &Walker) -> Result<(), Refusal> {
        walker.require(&setup.fields)?;
        channels::require_majorants(&setup.fields)?;
        walker.require_phases(&setup.problem.phases())?;
        realisable(setup)
    }

    fn second_moment_bounds(setup: &Setup<Self>, walker: &Walker) -> Result<Vec<f64>, Refusal> {
        if let Walker::Hero(_) = walker {
            channels::require_room(&setup.fields, true)?;
        }
        let spectrum = spectrum(setup);
        walker.second_moment_bounds(&setup.problem.phases(), |walk, channel, phi| {
            spectrum.second_moment_bound(walk, channel, phi)
        })
    }

    fn predict_independent(setup: &Setup<Self>, heroes: &[f64]) -> Prediction {
        spectrum(setup).independent(heroes)
    }

    fn predict_balanced(setup: &Setup<Self>, heroes: &[f64]) -> Prediction {
        spectrum(setup).balanced(heroes)
    }

    fn predict_relative(
        setup: &Setup<Self>,
        walker: &Walker,
        second_moment_bounds: &[f64],
    ) -> Prediction {
        let heroes = walker.heroes().map(|heroes| heroes.of(setup.fields.len()));
        spectrum(setup).relative(heroes.as_deref(), second_moment_bounds)
    }
}

estimators! {
    ChromaticSlab on ChannelMedia:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
}

//! The forms of `slab` with `albedos`: one medium for all channels, or a list with one for each.

use std::slice;

use super::channels::{media, read_albedos, read_scatterers};
use super::slab::{Incidence, read_incidence, read_light};
use super::spectral_rod::{Colours, Values};
use super::{Problem, ProblemOption};
use media::catalogue::Settings;
use media::phase::Phase;
use media::{Body, Medium};

/// A slab with one albedo for each channel.
#[derive(Clone)]
pub struct SpectralSlab {
    medium: Medium,
    /// The albedos.
    pub colours: Colours,
    /// Light and phase function.
    pub incidence: Incidence,
}

impl SpectralSlab {
    /// A slab whose depth is the distance along a medium, with albedos in `[0, 1]`.
    pub fn new(medium: Medium, albedos: Vec<f64>, incidence: Incidence) -> Self {
        Self { medium, colours: Colours::new(albedos, true), incidence }
    }
}

impl Problem for SpectralSlab {
    type Value = Values;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (albedos, incidence) = (read_albedos(settings), read_incidence(settings));
        Some(Self::new(body?.medium(), albedos?, incidence?))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }
}

/// A slab in which every channel has a medium of its own.
pub struct ChromaticSlab {
    media: Vec<Medium>,
    /// The albedos, and what is seen.
    pub colours: Colours,
    /// Light, the same in all channels, and the phase function of each.
    pub incidences: Vec<Incidence>,
}

impl ChromaticSlab {
    /// A slab with a medium, an albedo in `[0, 1]` and an incidence for each channel.
    pub fn new(media: Vec<Medium>, albedos: Vec<f64>, incidences: Vec<Incidence>) -> Self {
        Self { media, colours: Colours::new(albedos, true), incidences }
    }

    /// The phase functions of all channels.
    pub fn phases(&self) -> Vec<Phase> {
        self.incidences.iter().map(|incidence| incidence.phase).collect()
    }
}

impl Problem for ChromaticSlab {
    type Value = Values;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos, ProblemOption::Media];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (light, scatterers) = (read_light(settings), read_scatterers(body, settings));
        let (light, (albedos, phases)) = (light?, scatterers?);
        let incidences = phases.into_iter().map(|phase| Incidence { light, phase }).collect();
        Some(Self::new(media(body?), albedos, incidences))
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

//! What a slab sends back and lets through where every channel (wavelength) has a medium of its own.
//!
//! ```text
//! as in `slab`, with σ_t, albedo a and phase function of the channel λ = 1 … N
//! R_λ, T_λ: reflectance and transmittance of the slab of that channel
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium = [{ NAME = { … } }, …]` with `span = [from, to]` | σ_t as a function of the depth z for each of 1 to 8 channels, and the slab | one of the two |
//! | `volume = [{ NAME = { … } }, …]` with `ray = { origin, direction, length }` | `σ_t(z)` of each channel as a ray through a 3-D field sees it, within the same bounds | is required |
//! | `albedos` | 1 to 8 numbers in [0, 1], one for each channel | required |
//! | `phases = [{ NAME = { … } }, …]` | a phase function for each channel: `trueflight list phases` | required |
//! | `incidence.collimated = { cosine = μ₀ }` | light from one direction, 0 < μ₀ ≤ 1; 1 is straight down | one of the two |
//! | `incidence.diffuse = {}` | light evenly from all sides, the Lambertian law 2μ₀ dμ₀ | is required |
//! | `sampling` | a constant σ̂ of every estimator without its own: a table for all channels, or a list with one for each | required unless swept |
//! | `sweep` | one of `sampling` (the same σ̂ for all channels), `sampling-scale`, `density`, `albedo-scale`, `contrast` | none |
//! | `estimators` | what is tested | required |
//!
//! The channels of a draw are the reflectances that are not 0 and the transmittances. The answer of each channel is that
//! of `slab`, by adding and doubling. One lookup answers σ_t of all channels. Channels that differ in their albedo alone are
//! `spectral-slab`, of which theory knows more.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light Transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.1; S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950).

use super::slab::{Incidence, read_light};
use super::spectral_rod::{Colours, Values};
use super::{Problem, spectral_furnace};
use media::catalogue::Settings;
use media::phase::Phase;
use media::{Body, Medium};

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

    const SPECTRAL: bool = true;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let light = read_light(settings);
        let scatterers = spectral_furnace::read_scatterers(body, settings);
        let (light, (albedos, phases), bodies) = (light?, scatterers?, body?.channels());
        let incidences = phases.into_iter().map(|phase| Incidence { light, phase }).collect();
        let media = bodies.iter().map(Body::medium).collect();
        Some(Self::new(media, albedos, incidences))
    }

    fn medium(&self) -> &Medium {
        &self.media[0]
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

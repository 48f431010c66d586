//! The radiance that a ray gathers from a point light by single scattering, in several channels (wavelengths).
//!
//! ```text
//! as in `single-scattering`, with σ_t, albedo a and phase function of the channel λ = 1 … N
//! L_λ = ∫ T_λ(o, s) σ_t,λ(s) a_λ p_λ(cos θ) Φ/(4π r²) T_λ(p(s), l) ds
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume = [{ NAME = { … } }, …]` with `ray = { origin, direction, length }` | a field in space for each of 1 to 8 channels, within the same bounds, and the ray | required |
//! | `light = { position, power }` | a point light that shines alike in all directions and channels | power 1 |
//! | `albedos` | 1 to 8 numbers above 0 and up to 1, one for each channel | required |
//! | `phases = [{ NAME = { … } }, …]` | a phase function for each channel: `trueflight list phases` | required |
//! | `sampling` | a constant σ̂ of every estimator without its own: a table for all channels, or a list with one for each | required unless swept |
//! | `sweep` | one of `sampling` (the same σ̂ for all channels), `sampling-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! The answer of each channel is a quadrature over s to 12 digits. One lookup answers σ_t of all channels.
//!
//! Sources: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light Transport Estimators for
//! Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017), section 4.3, Eq. 22; B. Miller, I. Georgiev, W.
//! Jarosz, *A Null-Scattering Path Integral Formulation of Light Transport*, ACM Transactions on Graphics 38 (2019), section 5.

use std::sync::Arc;

use super::single_scattering::{Lamp, OnTheLine};
use super::{Problem, SingleScattering, spectral_furnace};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use media::{Body, Medium};

/// The values of one draw.
pub type Values = super::Values<MOST_CHANNELS>;

/// Single scattering of a point light in several channels.
pub struct SpectralSingleScattering {
    /// Each channel by itself.
    pub channels: Vec<Arc<SingleScattering>>,
    /// Their albedos.
    pub albedos: Vec<f64>,
    media: Vec<Medium>,
}

impl SpectralSingleScattering {
    /// What a draw scores.
    #[inline(always)]
    pub fn values(&self, at: [f64; MOST_CHANNELS]) -> Values {
        Values { at, count: self.channels.len() }
    }
}

impl Problem for SpectralSingleScattering {
    type Value = Values;

    const SPECTRAL: bool = true;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let lamp = Lamp::read(settings);
        let scatterers = spectral_furnace::read_channels(body, settings);
        let (lamp, scatterers, bodies) = (lamp?, scatterers?, body?.channels());
        if let Some(dark) = scatterers.iter().position(|channel| channel.albedo <= 0.0) {
            let found = format!("nothing is scattered in channel {}", dark + 1);
            settings.fault("albedos", found, "every albedo is above 0");
            return None;
        }
        let Body::Volume { ray, .. } = &bodies[0] else { return None };
        let channel = |of: &spectral_furnace::Channel| {
            SingleScattering::new(of.volume.clone(), *ray, lamp, of.albedo, of.phase).map(Arc::new)
        };
        let channels: Result<Vec<_>, OnTheLine> = scatterers.iter().map(channel).collect();
        if let Err(OnTheLine(distance)) = channels {
            let found = format!("the light is {distance:e} away from the line of the ray");
            settings.fault("light", found, "move it off the line: on the ray L is infinite");
        }
        let channels = channels.ok()?;
        let media = channels.iter().map(|channel| channel.medium().clone()).collect();
        let albedos = scatterers.iter().map(|channel| channel.albedo).collect();
        Some(Self { channels, albedos, media })
    }

    fn medium(&self) -> &Medium {
        &self.media[0]
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

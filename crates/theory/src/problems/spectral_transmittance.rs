//! The transmittance of a ray through a chromatic medium, all channels (wavelengths) by one draw.
//!
//! ```text
//! T_λ = exp(−∫ σ_t,λ(t) dt),  λ = 1 … N;   Y = Σ_λ l_λ T_λ
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium = [{ NAME = { … } }, …]` with `span = [from, to]` | a field in 1-D for each of 1 to 8 channels | one of the two |
//! | `volume = [{ NAME = { … } }, …]` with `ray = { origin, direction, length }` | a field in 3-D for each channel, within the same bounds | is required |
//! | `sampling` | σ̂ of every estimator without its own: a table for all channels, or a list with one for each | required unless swept |
//! | `sweep` | one of `sampling` (the same σ̂ for all channels), `sampling-scale`, `density`, `contrast` | none |
//! | `estimators` | what is tested | required |
//!
//! The channels of a draw are the N transmittances and, for N > 1, the luminance Y: with weights l =
//! (.2126, .7152, .0722) for N = 3 (red, green, blue of ITU-R BT.709) and 1/N elsewhere. Means, variances and
//! the covariances of neighbouring channels are tested.
//!
//! One lookup answers σ_t of all channels.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), sections 5.1 and 6.

use super::Problem;
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use media::{Body, Medium};

/// The most values of one draw: those of the channels, and the luminance.
pub const MOST: usize = MOST_CHANNELS + 1;

/// The values of one draw.
pub type Values = super::Values<MOST>;

/// The transmittance of a chromatic medium.
pub struct SpectralTransmittance {
    media: Vec<Medium>,
    /// The weights of the channels in the luminance; none where there is one channel.
    pub luminance: Vec<f64>,
}

impl SpectralTransmittance {
    /// Through the media of the channels, of which there is at least one.
    pub fn new(media: Vec<Medium>) -> Self {
        let count = if media.len() > 1 { media.len() } else { 0 };
        let luminance = (0..count).map(|channel| luminance(count, channel)).collect();
        Self { media, luminance }
    }

    /// What a draw scores, given the transmittance of each channel.
    #[inline(always)]
    pub fn values(&self, transmittances: &[f64]) -> Values {
        let mut values = Values { at: [0.0; MOST], count: transmittances.len() };
        values.at[..transmittances.len()].copy_from_slice(transmittances);
        if !self.luminance.is_empty() {
            let terms = self.luminance.iter().zip(transmittances);
            values.at[values.count] = terms.map(|(weight, value)| weight * value).sum();
            values.count += 1;
        }
        values
    }
}

/// The weight of one of N channels in the luminance.
#[inline(always)]
pub fn luminance(channels: usize, channel: usize) -> f64 {
    const BT709: [f64; 3] = [0.2126, 0.7152, 0.0722];
    if channels == BT709.len() { BT709[channel] } else { 1.0 / channels as f64 }
}

impl Problem for SpectralTransmittance {
    type Value = Values;

    const SPECTRAL: bool = true;

    fn read(body: Option<&Body>, _: &Settings) -> Option<Self> {
        Some(Self::new(body?.channels().iter().map(Body::medium).collect()))
    }

    fn medium(&self) -> &Medium {
        &self.media[0]
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

//! The form of `transmittance` with a list of media.

use super::channels::media;
use super::{Problem, ProblemOption};
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

    /// Values of a draw with the given transmittances.
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

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Media];

    fn read(body: Option<&Body>, _: &Settings) -> Option<Self> {
        Some(Self::new(media(body?)))
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

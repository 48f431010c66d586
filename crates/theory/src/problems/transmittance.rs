//! The transmittance of a ray, at its end or at many distances, of one channel (wavelength) or several.
//!
//! ```text
//! T = exp(−∫ σ_t(t) dt);   T(s_k) = exp(−∫₀^{s_k} σ_t(t) dt),  k = 1 … K;   T_λ = exp(−∫ σ_t,λ(t) dt),  λ = 1 … N
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | a field in 1-D and where it is asked about | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | a field in 3-D and a ray through it | is required |
//! | `distances` | K, from 2 to 16: T at so many distances, equally spaced up to the end of the ray, all from one walk | the end alone |
//! | `sampling` | σ̂ of every estimator without its own | required unless swept |
//! | `control` | σ_c of every estimator that takes one and has none of its own | none |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `control`, `points`, `density`; of several channels `sampling`, `sampling-scale`, `density`, `contrast` | none |
//! | `estimators` | what is tested | required |
//!
//! **Several channels**: `medium` or `volume` is a list of 1 to 8 fields, within the same bounds, and `sampling` a σ̂ for
//! all of them or a list with one for each. One lookup answers σ_t of all channels. The channels of a draw are the N
//! transmittances and, for N > 1, the luminance `Y = Σ l_λ T_λ`: with weights l = (.2126, .7152, .0722) for N = 3 (red,
//! green, blue of ITU-R BT.709) and 1/N elsewhere. Means, variances and the covariances of neighbouring channels are
//! tested.
//!
//! **A curve** is of one channel. Means, variances and the covariance matrix are tested. The record also holds the ray's
//! anatomy, as in Figures 5 and 8 of Szirmay-Kalos et al. 2017.
//!
//! Beyond `τ = 300` the square of T is no longer a double: draws, truth and moments are then in units
//! of `e^{−τ}`, and T itself is never formed. The answer is exact because every field of the catalogue has an
//! exact optical depth.
//!
//! Sources: L. Szirmay-Kalos et al., *Unbiased Light Transport Estimators for Inhomogeneous Participating Media*,
//! Computer Graphics Forum 36 (2017); B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of
//! Light Transport*, ACM Transactions on Graphics 38 (2019), sections 5.1 and 6.
//!
//! ```toml
//! title = "An example of transmittance"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.6
//! control = 0.4
//! estimators = ["woodcock", "ratio", "residual-ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use std::slice;

use super::channels::media;
use super::{Problem, ProblemOption, Values};
use media::body::MAX_CHANNELS;
use media::catalogue::Settings;
use media::{Body, Medium};

/// Optical depth beyond which values are in units of `e^{−τ}`.
const THICK: f64 = 300.0;

/// Largest number of distances of a curve.
pub const MAX_DISTANCES: usize = 16;

/// The transmittance of the whole ray.
pub struct Transmittance {
    medium: Medium,
}

impl Transmittance {
    /// The transmittance of a medium's ray.
    pub fn new(medium: Medium) -> Self {
        Self { medium }
    }
}

impl Problem for Transmittance {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, _: &Settings) -> Option<Self> {
        Some(Self { medium: body?.medium() })
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }

    fn log_unit(&self, depth: f64) -> f64 {
        if depth > THICK { depth } else { 0.0 }
    }
}

/// The values of one draw of a curve, one for each distance.
pub type CurveValues = Values<MAX_DISTANCES>;

/// The transmittance at ascending distances.
pub struct TransmittanceCurve {
    medium: Medium,
    distances: Vec<f64>,
}

impl TransmittanceCurve {
    /// The distances, ascending.
    pub fn ascending(&self) -> &[f64] {
        &self.distances
    }
}

impl Problem for TransmittanceCurve {
    type Value = CurveValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Distances];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let count = settings.count("distances", 2..=MAX_DISTANCES as u64)?;
        let medium = body?.medium();
        let span = medium.span();
        let step = span.length() / count as f64;
        let mut distances: Vec<f64> = (1..count).map(|k| span.from + step * k as f64).collect();
        distances.push(span.to);
        Some(Self { medium, distances })
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }

    fn distances(&self) -> Vec<f64> {
        self.distances.clone()
    }
}

/// The values of one draw in several channels: their transmittances, and the luminance.
pub type SpectralValues = Values<{ MAX_CHANNELS + 1 }>;

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
}

/// The weight of one of N channels in the luminance.
#[inline(always)]
pub fn luminance(channels: usize, channel: usize) -> f64 {
    const BT709: [f64; 3] = [0.2126, 0.7152, 0.0722];
    if channels == BT709.len() { BT709[channel] } else { 1.0 / channels as f64 }
}

impl Problem for SpectralTransmittance {
    type Value = SpectralValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Media];

    fn read(body: Option<&Body>, _: &Settings) -> Option<Self> {
        Some(Self::new(media(body?)))
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

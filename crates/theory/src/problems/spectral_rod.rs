//! What a rod of coloured scatterers sends back and lets through: one albedo for each channel (wavelength).
//!
//! ```text
//! as in `rod`, with the albedo a_λ of the channel λ = 1 … N, and one extinction for all of them
//! R_λ = Σ_r a_λ^r R_r,  T_λ = Σ_r a_λ^r T_r,  r the number of scatterings
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | a field in 1-D and where it is asked about | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | a field in 3-D and a ray through it: the rod | is required |
//! | `albedos` | 1 to 8 numbers in [0, 1], one for each channel | required |
//! | `forward` | `p_f` in [0, 1], the probability that scattering keeps the direction | 0.5 |
//! | `sampling` | σ̂ ≥ σ_t of every estimator without its own | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `density`, `albedo-scale`, `contrast` | none |
//! | `estimators` | what is tested | required |
//!
//! The channels of a draw are the reflectances that are not 0 and the transmittances. All moments of all
//! estimators depend on the optical length alone and are closed forms, whatever the fields σ_t and σ̂ are.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5, in one dimension.

use super::{Problem, number};
use media::body::MOST_CHANNELS;
use media::catalogue::{Domain, Settings};
use media::{Body, Medium};

/// The most values of one draw.
pub const MOST: usize = 2 * MOST_CHANNELS;

/// The values of one draw.
pub type Values = super::Values<MOST>;

/// Where a particle leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At the beginning.
    Reflected,
    /// At the end.
    Transmitted,
}

/// One albedo for each channel, and what is seen of the body that has them.
#[derive(Debug, Clone)]
pub struct Colours {
    /// The albedo of each channel.
    pub albedos: Vec<f64>,
    /// The end and the channel of each value of a draw.
    pub seen: Vec<(End, usize)>,
}

impl Colours {
    /// Albedos in `[0, 1]` of a body that may send light back, or never does.
    pub fn new(albedos: Vec<f64>, may_come_back: bool) -> Self {
        let all = 0..albedos.len();
        let comes_back = |&channel: &usize| albedos[channel] > 0.0 && may_come_back;
        let reflected = all.clone().filter(comes_back).map(|channel| (End::Reflected, channel));
        let seen = reflected.chain(all.map(|channel| (End::Transmitted, channel))).collect();
        Self { albedos, seen }
    }

    /// Reads `albedos`.
    pub fn read_albedos(settings: &Settings) -> Option<Vec<f64>> {
        let albedos = settings.numbers("albedos", Domain::Unit, 1)?;
        if albedos.len() > MOST_CHANNELS {
            let message = format!("`albedos` lists {} channels", albedos.len());
            settings.fault("albedos", message, format!("it takes 1 to {MOST_CHANNELS}"));
            return None;
        }
        Some(albedos)
    }

    /// The values of a draw that left at an end with a weight for each channel.
    #[inline(always)]
    pub fn values(&self, left: Option<End>, weights: &[f64; MOST_CHANNELS]) -> Values {
        let mut values = Values { at: [0.0; MOST], count: self.seen.len() };
        for (value, (end, channel)) in values.at.iter_mut().zip(&self.seen) {
            *value = if left == Some(*end) { weights[*channel] } else { 0.0 };
        }
        values
    }
}

/// A rod with one albedo for each channel.
#[derive(Clone)]
pub struct SpectralRod {
    medium: Medium,
    /// The albedos.
    pub colours: Colours,
    /// `p_f`.
    pub forward: f64,
}

impl SpectralRod {
    /// A rod with albedos and a probability to scatter forward, all in `[0, 1]`.
    pub fn new(medium: Medium, albedos: Vec<f64>, forward: f64) -> Self {
        Self { medium, colours: Colours::new(albedos, forward < 1.0), forward }
    }
}

impl Problem for SpectralRod {
    type Value = Values;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedos = Colours::read_albedos(settings);
        let forward = number(settings, "forward", Some(0.5));
        Some(Self::new(body?.medium(), albedos?, forward?))
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }
}

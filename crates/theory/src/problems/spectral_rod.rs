//! The form of `rod` with `albedos`, and what coloured rods and slabs have in common.

use std::slice;

use super::channels::read_albedos;
use super::{Problem, ProblemOption, number};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use media::{Body, Medium};

/// The most values of one draw.
pub const MOST: usize = 2 * MOST_CHANNELS;

/// The values of one draw.
pub type Values = super::Values<MOST>;

/// End at which a particle leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At the beginning.
    Reflected,
    /// At the end.
    Transmitted,
}

/// One albedo for each channel, and the values of a draw.
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

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Albedos];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedos = read_albedos(settings);
        let forward = number(settings, "forward", Some(0.5));
        Some(Self::new(body?.medium(), albedos?, forward?))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }
}

//! What a camera sees of an emitter through a rod, in several channels (wavelengths) by one draw.
//!
//! ```text
//! as in `lit-rod`, with σ_t, albedo a and forward probability p_f of the channel λ = 1 … N
//! L_λ is the chance that a path of that channel reaches the emitter: the rod's transmittance
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium = [{ NAME = { … } }, …]` with `span = [from, to]` | a field in 1-D for each of 1 to 8 channels | one of the two |
//! | `volume = [{ NAME = { … } }, …]` with `ray = { origin, direction, length }` | a field in 3-D for each channel, within the same bounds | is required |
//! | `albedos` | a in [0, 1], one for each channel: numbers, or fields as in `rod` | required |
//! | `forward` | `p_f` in [0, 1], the probability that scattering keeps the direction: a number, or a list with one for each channel | 0.5 |
//! | `sampling` | σ̂ ≥ σ_t of every estimator without its own: a table for all channels, or a list with one for each | required unless swept |
//! | `sweep` | one of `sampling` (the same σ̂ for all channels), `sampling-scale`, `density`, `albedo-scale`, `contrast` | none |
//! | `estimators` | what is tested | required |
//!
//! The emitter touches the medium in every channel. Means, variances and the covariances of neighbouring channels
//! are tested. One lookup answers σ_t of all channels.
//!
//! The answer is exact. Moments are exact where one channel is drawn at a time, where all channels have the same σ_t and
//! σ̂ and albedos are numbers, and of hits where light goes on forward through what is constant in each cell; elsewhere
//! variances of draws that score all channels at once are bounded.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), sections 5.3 and 5.4, on the rod of `lit-rod`.

use super::lit_rod::before_emitter;
use super::rod::shares;
use super::{LitRod, Problem, number};
use media::body::MOST_CHANNELS;
use media::catalogue::{Domain, Settings, Value};
use media::{Body, Medium, Piecewise};
use numeric::Lane;

/// The values of one draw.
pub type Values = super::Values<MOST_CHANNELS>;

/// A rod with an emitter at its end, in several channels.
pub struct SpectralLitRod {
    media: Vec<Medium>,
    /// The rod of each channel.
    pub rods: Vec<LitRod>,
    /// `p_f` of each channel.
    pub forward: Vec<f64>,
}

impl SpectralLitRod {
    /// Through the media of the channels, with one albedo and one probability to scatter forward for each.
    pub fn new(media: Vec<Medium>, albedos: &[Piecewise], forward: Vec<f64>) -> Self {
        let rod = |((medium, albedo), &forward): ((&Medium, &Piecewise), &f64)| {
            let forward = Piecewise::constant(forward, medium.span());
            LitRod::new(medium.clone(), albedo, &forward)
        };
        let rods = media.iter().zip(albedos).zip(&forward).map(rod).collect();
        Self { media, rods, forward }
    }

    /// a of each channel, where they are numbers.
    pub fn albedos(&self) -> Option<Vec<f64>> {
        let one = |rod: &LitRod| rod.rod.albedo.on(self.media[0].support()).single_value();
        self.rods.iter().map(one).collect()
    }

    /// a of a channel at a distance.
    #[inline(always)]
    pub fn albedo<L: Lane>(&self, channel: usize, t: L) -> L {
        self.rods[channel].rod.albedo.value(t)
    }

    /// What a draw scores.
    #[inline(always)]
    pub fn values(&self, at: [f64; MOST_CHANNELS]) -> Values {
        Values { at, count: self.rods.len() }
    }
}

impl Problem for SpectralLitRod {
    type Value = Values;

    const SPECTRAL: bool = true;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedos = shares(settings, "albedos");
        let forward = settings.entry("forward");
        let forward = if forward.is_some_and(|entry| matches!(entry.node.value, Value::Array(_))) {
            settings.numbers("forward", Domain::Unit, 1)
        } else {
            number(settings, "forward", Some(0.5)).map(|forward| vec![forward])
        };
        let channels = body?.channels();
        let media = channels.iter().map(|channel| before_emitter(channel, settings));
        let media: Vec<Medium> = media.collect::<Option<_>>()?;
        let (albedos, mut forward) = (albedos?, forward?);
        if forward.len() == 1 {
            forward = vec![forward[0]; media.len()];
        }
        for (key, listed) in [("albedos", albedos.len()), ("forward", forward.len())] {
            if listed != media.len() {
                let count = media.len();
                let message =
                    format!("`{key}` lists {listed} channels, and the medium has {count}");
                settings.fault(key, message, "give one for each channel");
                return None;
            }
        }
        Some(Self::new(media, &albedos, forward))
    }

    fn medium(&self) -> &Medium {
        &self.media[0]
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

//! The radiance along a ray into a furnace in several channels (wavelengths): in each of them it is 1.
//!
//! ```text
//! as in `furnace`, with σ_t, albedo a and phase function of the channel λ = 1 … N
//! L_λ = the chance of a walk of that channel to be absorbed, or to leave: 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `volume = [{ NAME = { … } }, …]` with `ray = { origin, direction, length }` | a field in space for each of 1 to 8 channels, within the same bounds, and a ray that meets them | required |
//! | `albedos` | 1 to 8 numbers in [0, 1], one for each channel | required |
//! | `phases = [{ NAME = { … } }, …]` | a phase function for each channel: `trueflight list phases` | required |
//! | `sampling` | a constant σ̂ of every estimator without its own: a table for all channels, or a list with one for each | required unless swept |
//! | `sweep` | one of `sampling` (the same σ̂ for all channels), `sampling-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! Kirchhoff's law holds in every channel, whatever the media are: all that comes in is absorbed or leaves, and where
//! the medium absorbs it emits. So walks in space that score all channels at once have an exact answer in every medium.
//! One lookup answers σ_t of all channels.
//!
//! Sources: G. Kirchhoff, *Ueber das Verhältniss zwischen dem Emissionsvermögen und dem Absorptionsvermögen der Körper
//! für Wärme und Licht*, Annalen der Physik 185 (1860); B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path
//! Integral Formulation of Light Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use std::sync::Arc;

use super::Problem;
use media::body::MOST_CHANNELS;
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::{Body, Medium, Volume, misses};
use numeric::geometry::{Bounds, Point};

/// The values of one draw.
pub type Values = super::Values<MOST_CHANNELS>;

/// The medium of one channel.
#[derive(Clone)]
pub struct Channel {
    /// σ_t.
    pub volume: Arc<Volume>,
    /// a.
    pub albedo: f64,
    /// How light is scattered.
    pub phase: Phase,
}

/// The radiance along a ray into a furnace in several channels.
pub struct SpectralFurnace {
    /// The medium of each channel.
    pub channels: Vec<Channel>,
    /// Their albedos.
    pub albedos: Vec<f64>,
    /// Where all of them are.
    pub bounds: Bounds,
    /// Where the ray enters the bounds, or begins within them.
    pub entry: Point,
    /// The direction of the ray.
    pub direction: Point,
    media: Vec<Medium>,
}

/// Reads `albedos` and `phases`, one of each for each channel of a field.
pub fn read_scatterers(body: Option<&Body>, settings: &Settings) -> Option<(Vec<f64>, Vec<Phase>)> {
    let albedos = settings.numbers("albedos", Domain::Unit, 1);
    let phases = settings.tables("phases").and_then(|tables| {
        let phases: Vec<_> = tables.iter().map(Phase::read_listed).collect();
        phases.into_iter().collect::<Option<Vec<Phase>>>()
    });
    let (albedos, phases, count) = (albedos?, phases?, body?.channels().len());
    for (key, listed) in [("albedos", albedos.len()), ("phases", phases.len())] {
        if listed != count {
            let message = format!("`{key}` lists {listed} channels, and the medium has {count}");
            settings.fault(key, message, "give one for each channel");
            return None;
        }
    }
    Some((albedos, phases))
}

/// Reads `albedos` and `phases` beside a field in space for each channel.
pub fn read_channels(body: Option<&Body>, settings: &Settings) -> Option<Vec<Channel>> {
    let (albedos, phases) = read_scatterers(body, settings)?;
    let bodies = body?.channels();
    let mut channels = Vec::new();
    for ((body, albedo), phase) in bodies.iter().zip(albedos).zip(phases) {
        let Body::Volume { volume, .. } = body else {
            let help = "write `volume` instead of `medium`";
            settings.fault("medium", "particles walk through a field in space", help);
            return None;
        };
        channels.push(Channel { volume: volume.clone(), albedo, phase });
    }
    let bounds = channels[0].volume.bounds();
    if channels.iter().any(|channel| channel.volume.bounds() != bounds) {
        let found = "the channels do not fill the same part of space";
        settings.fault("volume", found, "give all of them the same `bounds`");
        return None;
    }
    Some(channels)
}

impl SpectralFurnace {
    /// What a draw scores.
    #[inline(always)]
    pub fn scored(&self, at: [f64; MOST_CHANNELS]) -> Values {
        Values { at, count: self.channels.len() }
    }
}

impl Problem for SpectralFurnace {
    type Value = Values;

    const SPECTRAL: bool = true;

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let channels = read_channels(body, settings)?;
        let bodies = body?.channels();
        let (Body::Volume { ray, .. }, bounds) = (&bodies[0], channels[0].volume.bounds()) else {
            return None;
        };
        if bounds.enclosing_box().is_none() {
            let help = "give each channel the same `bounds.sphere` or `bounds.box`";
            settings.fault("volume", "particles would never leave a volume without bounds", help);
            return None;
        }
        let inside = bounds.clip(ray);
        if inside.is_empty() {
            let help = "turn it, or move its origin: what misses the volume tests nothing";
            let found = format!("the ray misses the volume, whose {}", misses::place(bounds));
            settings.fault("ray", found, help);
            return None;
        }
        let media = bodies.iter().map(Body::medium).collect();
        let albedos = channels.iter().map(|channel| channel.albedo).collect();
        let (entry, direction) = (ray.at(inside.from), ray.direction);
        Some(Self { channels, albedos, bounds, entry, direction, media })
    }

    fn medium(&self) -> &Medium {
        &self.media[0]
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

//! Settings of several channels (wavelengths): a value, or a medium, for each.

use std::sync::Arc;

use super::Values;
use super::scene::in_space;
use media::body::MAX_CHANNELS;
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::{Body, Medium, Volume};

/// The medium of one channel in space.
#[derive(Clone)]
pub struct Channel {
    /// σ_t.
    pub volume: Arc<Volume>,
    /// a.
    pub albedo: f64,
    /// Phase function.
    pub phase: Phase,
}

/// The values of one draw of a coloured rod or slab: what leaves at each end, in each channel.
pub type ColourValues = Values<{ 2 * MAX_CHANNELS }>;

/// End at which a particle leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The beginning.
    Reflected,
    /// The end.
    Transmitted,
}

impl End {
    /// Name of what leaves there in a channel.
    pub fn name(self, channel: usize) -> String {
        let side = if self == Self::Reflected { "reflectance" } else { "transmittance" };
        format!("{side}, channel {}", channel + 1)
    }
}

/// Name of one of several channels, empty where there is one only.
pub fn channel_name(index: usize, count: usize) -> String {
    if count == 1 { String::new() } else { format!("channel {}", index + 1) }
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
}

/// The field of each channel along the ray.
pub(super) fn media(body: &Body) -> Vec<Medium> {
    body.channels().iter().map(Body::medium).collect()
}

/// Reads `albedos`, 1 to 8 numbers.
pub(super) fn read_albedos(settings: &Settings) -> Option<Vec<f64>> {
    let albedos = settings.numbers("albedos", Domain::Unit, 1)?;
    if albedos.len() > MAX_CHANNELS {
        let message = format!("`albedos` lists {} channels", albedos.len());
        settings.fault("albedos", message, format!("it takes 1 to {MAX_CHANNELS}"));
        return None;
    }
    Some(albedos)
}

/// Checks that settings list as many channels as the medium has.
pub(super) fn agree(
    settings: &Settings,
    count: usize,
    lists: [(&'static str, usize); 2],
) -> Option<()> {
    let (key, listed) = lists.into_iter().find(|&(_, listed)| listed != count).unzip();
    let (Some(key), Some(listed)) = (key, listed) else { return Some(()) };
    let message = format!("`{key}` lists {listed} channels, and the medium has {count}");
    settings.fault(key, message, "give one for each channel");
    None
}

/// Reads `albedos` and `phases`, one of each for each channel of a field.
pub(super) fn read_scatterers(
    body: Option<&Body>,
    settings: &Settings,
) -> Option<(Vec<f64>, Vec<Phase>)> {
    let albedos = read_albedos(settings);
    let phases = settings.tables("phases").and_then(|tables| {
        let phases: Vec<_> = tables.iter().map(Phase::read_listed).collect();
        phases.into_iter().collect::<Option<Vec<Phase>>>()
    });
    let (albedos, phases, count) = (albedos?, phases?, body?.channels().len());
    agree(settings, count, [("albedos", albedos.len()), ("phases", phases.len())])?;
    Some((albedos, phases))
}

/// Reads `albedos` and `phases` beside a field in space for each channel.
pub(super) fn read_channels(body: Option<&Body>, settings: &Settings) -> Option<Vec<Channel>> {
    let (albedos, phases) = read_scatterers(body, settings)?;
    let mut channels = Vec::new();
    for ((body, albedo), phase) in body?.channels().iter().zip(albedos).zip(phases) {
        let volume = in_space(body, settings)?.clone();
        channels.push(Channel { volume, albedo, phase });
    }
    let bounds = channels[0].volume.bounds();
    if channels.iter().any(|channel| channel.volume.bounds() != bounds) {
        let actual = "the channels do not fill the same part of space";
        settings.fault("volume", actual, "give all of them the same `bounds`");
        return None;
    }
    Some(channels)
}

//! The forms of `rod` with `light`: what a camera sees of an emitter through it, in one channel or several.

use super::channels::agree;
use super::rod::{Rod, RodQuantity, read_scattering, shares};
use super::{ChannelValues, Problem, ProblemOption, number as read_number};
use media::catalogue::{Domain, Settings, Value};
use media::{Body, Medium, Piecewise};
use numeric::Lane;
use numeric::digits::{number, rounded};

/// A support that ends so little before its ray, relative to the ray's length, ends with it.
const TOUCHES: f64 = 1e-9;

/// A rod with an emitter at its end.
pub struct LitRod {
    /// The rod; its one channel is what it transmits.
    pub rod: Rod,
}

impl LitRod {
    /// A rod with an albedo and a probability to scatter forward, both in `[0, 1]`.
    pub fn new(medium: Medium, albedo: &Piecewise, forward: &Piecewise) -> Self {
        Self { rod: Rod::new(medium, albedo, forward, vec![RodQuantity::Transmitted]) }
    }
}

/// Reads `light`: an emitter is the only one that a rod may have.
fn read_light(settings: &Settings) -> Option<()> {
    settings.word("light", &["emitter"]).map(drop)
}

/// The field along a rod that touches its emitter.
fn before_emitter(body: &Body, settings: &Settings) -> Option<Medium> {
    let key = if matches!(body, Body::Volume { .. }) { "ray" } else { "medium" };
    let medium = body.medium();
    let (span, support) = (medium.span(), medium.support());
    if span.to - support.to > TOUCHES * span.length() {
        let (end, bound) = (number(span.to), rounded(support.to));
        let actual = format!("the emitter, at {end}, is in a vacuum: the field ends at {bound}");
        settings.fault(key, actual, "end the ray inside the bounds of the field");
        return None;
    }
    if medium.optical_depth(support).value <= 0.0 {
        let actual = "the emitter is behind a vacuum: σ_t = 0 from the camera to it";
        settings.fault(key, actual, "give the rod some extinction");
        return None;
    }
    Some(medium)
}

impl Problem for LitRod {
    type Value = [f64; 1];

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Light];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (scattering, light) = (read_scattering(settings), read_light(settings));
        let medium = before_emitter(body?, settings)?;
        let ([albedo, forward], ()) = (scattering?, light?);
        Some(Self::new(medium, &albedo, &forward))
    }

    fn media(&self) -> &[Medium] {
        self.rod.media()
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        self.rod.with_albedo(albedo).map(|rod| Self { rod })
    }
}

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
}

impl Problem for SpectralLitRod {
    type Value = ChannelValues;

    const OPTIONS: &'static [ProblemOption] =
        &[ProblemOption::Light, ProblemOption::Albedos, ProblemOption::Media];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let (albedos, light) = (shares(settings, "albedos"), read_light(settings));
        let forward = settings.entry("forward");
        let forward = if forward.is_some_and(|entry| matches!(entry.node.value, Value::Array(_))) {
            settings.numbers("forward", Domain::Unit, 1)
        } else {
            read_number(settings, "forward", Some(0.5)).map(|forward| vec![forward])
        };
        let channels = body?.channels();
        let media = channels.iter().map(|channel| before_emitter(channel, settings));
        let media: Vec<Medium> = media.collect::<Option<_>>()?;
        let (albedos, mut forward) = (albedos?, forward?);
        if forward.len() == 1 {
            forward = vec![forward[0]; media.len()];
        }
        let lists = [("albedos", albedos.len()), ("forward", forward.len())];
        light.and(agree(settings, media.len(), lists))?;
        Some(Self::new(media, &albedos, forward))
    }

    fn media(&self) -> &[Medium] {
        &self.media
    }
}

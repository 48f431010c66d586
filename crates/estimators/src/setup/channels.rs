//! Fields of several channels (wavelengths) that one walk scores, and the requirements on their σ̂.

use std::sync::Arc;

use super::{ChannelPart, Fields, Line, OnRay, Parts, Refusal, Residual};
use media::{Control, Piecewise};
use numeric::Lane;
use numeric::digits::{number, rounded};
use theory::Mesh;

/// Largest share that is rounding: of null collisions, or relative to the largest share of all channels.
const TOUCHES: f64 = 1e-9;

/// Largest expected number of collisions on a ray.
const MAX_COLLISIONS: f64 = 1e6;

/// Medium and σ̂ of a channel (wavelength).
#[derive(Clone)]
pub struct ChannelFields {
    /// Medium, cut into panels.
    pub mesh: Arc<Mesh>,
    /// σ̂ on the support: one constant.
    pub sampling: Piecewise,
    /// σ̂, 1/length; zero for estimators that take none.
    pub majorant: f64,
    /// `ln σ̂`.
    pub ln_majorant: f64,
    /// `∫σ̂`.
    pub collisions: f64,
}

impl ChannelFields {
    /// Joins the parts of a channel, counted from 1; σ̂ is restricted to the support.
    ///
    /// # Errors
    ///
    /// σ̂ is not one constant above 0, or walks with it are too long.
    fn new(channel: usize, part: ChannelPart) -> Result<Self, Refusal> {
        let takes_none = part.1.is_none();
        let Line { mesh, sampling } = Line::new(part);
        let refused = |actual| Err(Refusal::mismatch("a constant σ̂ > 0 in each channel", actual));
        let Some(majorant) = sampling.single_value() else {
            return refused(format!("that of channel {channel} varies along the ray"));
        };
        if majorant <= 0.0 && !takes_none {
            return refused(format!("σ̂ = {} in channel {channel}", number(majorant)));
        }
        let collisions = majorant * mesh.support().length();
        if collisions.is_nan() || collisions > MAX_COLLISIONS {
            let actual = format!("∫σ̂ = {collisions:e} in channel {channel}");
            return Err(Refusal::mismatch("∫σ̂ ≤ 1e6 in each channel", actual));
        }
        Ok(Self { mesh, sampling, majorant, ln_majorant: Lane::ln(majorant), collisions })
    }
}

/// Medium and σ̂ of each channel; at least one channel.
pub type ChannelMedia = Vec<ChannelFields>;

impl<P> Fields<P> for ChannelMedia {
    fn new(_: &P, parts: Parts) -> Result<Self, Refusal> {
        let channels = (1..).zip(parts.channels);
        channels.map(|(channel, part)| ChannelFields::new(channel, part)).collect()
    }
}

impl OnRay for ChannelMedia {
    #[inline(always)]
    fn residual(&self) -> Residual<'_> {
        let ChannelFields { mesh, sampling, .. } = &self[0];
        Residual { mesh, sampling, control: &Control::None }
    }
}

/// Requires one σ̂ for all channels.
///
/// # Errors
///
/// Two σ̂ that differ.
pub fn require_common(channels: &[ChannelFields]) -> Result<(), Refusal> {
    let first = channels[0].majorant;
    let other = channels.iter().find(|channel| channel.majorant != first);
    other.map_or(Ok(()), |other| {
        let actual = format!("σ̂ = {} and {}", rounded(first), rounded(other.majorant));
        Err(Refusal::mismatch("one σ̂ for all channels", actual))
    })
}

/// Requires `σ̂ ≥ σ_t` in each channel.
///
/// # Errors
///
/// The channel, and the distance of the largest violation.
pub fn require_majorants(channels: &[ChannelFields]) -> Result<(), Refusal> {
    for (number, channel) in (1..).zip(channels) {
        let worst = channel.mesh.largest(&|_, sigma| sigma);
        if let Some((at, sigma)) = worst.filter(|&(_, s)| s > channel.majorant * (1.0 + 1e-12)) {
            let [majorant, sigma] = [channel.majorant, sigma].map(rounded);
            return Err(Refusal::Inequality {
                needs: "σ̂ ≥ σ_t in each channel".into(),
                actual: format!("σ̂ = {majorant} and σ_t = {sigma} in channel {number}"),
                at,
            });
        }
    }
    Ok(())
}

/// Requires that every hero has the events of all channels. Its σ̂ may equal its σ_t only where σ̂ = σ_t in every other
/// channel. If walks scatter, its σ_t may be 0 only where σ_t = 0 in every other channel.
///
/// # Errors
///
/// The channel and the place, and whether the draws are biased or their variance is infinite.
pub fn require_room(channels: &[ChannelFields], scatters: bool) -> Result<(), Refusal> {
    let real = |own: &ChannelFields, t: f64| own.mesh.medium().extinction(t) / own.majorant;
    let null = |own: &ChannelFields, t: f64| 1.0 - real(own, t);
    for (number, hero) in channels.iter().enumerate() {
        let majorant = rounded(hero.majorant);
        let room = Room {
            share: &null,
            none: TOUCHES,
            needs: "σ̂ > σ_t of the hero wherever another channel has null collisions",
            stretch: format!("σ̂ = σ_t = {majorant}"),
            touch: format!("σ̂ = {majorant} touches σ_t"),
        };
        room.require(channels, number)?;
        if scatters {
            let room = Room {
                share: &real,
                none: 0.0,
                needs: "σ_t > 0 of the hero wherever another channel scatters",
                stretch: "σ_t = 0".into(),
                touch: "σ_t comes down to 0".into(),
            };
            room.require(channels, number)?;
        }
    }
    Ok(())
}

/// Event that a hero must have wherever another channel has it.
struct Room<'a> {
    /// Share of the event among a channel's collisions at a distance.
    share: &'a dyn Fn(&ChannelFields, f64) -> f64,
    /// Largest share that counts as 0.
    none: f64,
    needs: &'static str,
    /// Words for a hero that lacks it on a stretch, and at a distance.
    stretch: String,
    touch: String,
}

impl Room<'_> {
    /// Ratio of the hero's share to the largest share of all channels; 1 where all are 0.
    fn beside(&self, channels: &[ChannelFields], number: usize, t: f64) -> f64 {
        let share = |channel: &ChannelFields| (self.share)(channel, t);
        let maximum = channels.iter().map(share).fold(0.0, f64::max);
        if maximum > self.none { share(&channels[number]) / maximum } else { 1.0 }
    }

    fn require(&self, channels: &[ChannelFields], number: usize) -> Result<(), Refusal> {
        let (hero, Self { share, none, needs, stretch, touch }) = (&channels[number], self);
        let cuts: Vec<f64> =
            channels.iter().flat_map(|c| c.mesh.panels().map(|panel| panel.span.from)).collect();
        let cut = hero.mesh.refined(&cuts, &|_, _| Vec::new());
        let beside = |t: f64| self.beside(channels, number, t);
        // Missing at every node of a panel: on a stretch.
        let missing = cut.panels().find(|panel| {
            panel.t.iter().all(|&t| share(hero, t) <= *none) && beside(panel.span.middle()) < 1.0
        });
        let number = number + 1;
        if let Some(panel) = missing {
            let actual =
                format!("{stretch} in channel {number} on a stretch, which biases the others,");
            let needs = (*needs).into();
            return Err(Refusal::Inequality { needs, actual, at: panel.span.from });
        }
        let touches =
            cut.peaks(&|t| -beside(t)).into_iter().find(|&(_, actual)| -actual <= TOUCHES);
        if let Some((at, _)) = touches {
            let actual = format!("{touch} in channel {number}: E[X²] is infinite");
            return Err(Refusal::Inequality { needs: "a finite variance".into(), actual, at });
        }
        Ok(())
    }
}

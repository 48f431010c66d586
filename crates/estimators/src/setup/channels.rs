//! What σ̂ must be where several channels (wavelengths) are scored by one walk.

use super::{Refusal, SpectralChannel};
use numeric::digits::rounded;

/// A share of null collisions below this is none, and a share beside that of another channel.
const TOUCHES: f64 = 1e-9;

/// A constant σ̂ > 0 in each channel, and so few collisions that walks end.
///
/// # Errors
///
/// What σ̂ is instead, and of which channel.
pub fn require_constants(channels: &[SpectralChannel]) -> Result<(), Refusal> {
    for (number, channel) in (1..).zip(channels) {
        if channel.majorant <= 0.0 {
            let found = format!("that of channel {number} varies along the ray");
            return Err(Refusal::mismatch("a constant σ̂ > 0 in each channel", found));
        }
        if channel.collisions.is_nan() || channel.collisions > 1e6 {
            let found = format!("∫σ̂ = {:e} in channel {number}", channel.collisions);
            return Err(Refusal::mismatch("∫σ̂ ≤ 1e6 in each channel", found));
        }
    }
    Ok(())
}

/// The same σ̂ in all channels.
///
/// # Errors
///
/// Two that differ.
pub fn require_common(channels: &[SpectralChannel]) -> Result<(), Refusal> {
    let first = channels[0].majorant;
    let other = channels.iter().find(|channel| channel.majorant != first);
    other.map_or(Ok(()), |other| {
        let found = format!("σ̂ = {} and {}", rounded(first), rounded(other.majorant));
        Err(Refusal::mismatch("one σ̂ for all channels", found))
    })
}

/// `σ̂ ≥ σ_t` in each channel.
///
/// # Errors
///
/// The channel, and where it is violated most.
pub fn require_majorants(channels: &[SpectralChannel]) -> Result<(), Refusal> {
    for (number, channel) in (1..).zip(channels) {
        let worst = channel.mesh.largest(|_, sigma| sigma);
        if let Some((at, sigma)) = worst.filter(|&(_, s)| s > channel.majorant * (1.0 + 1e-12)) {
            let [majorant, sigma] = [channel.majorant, sigma].map(rounded);
            return Err(Refusal::Inequality {
                needs: "σ̂ ≥ σ_t in each channel",
                found: format!("σ̂ = {majorant} and σ_t = {sigma} in channel {number}"),
                at,
            });
        }
    }
    Ok(())
}

/// No hero lacks what happens in another channel: its σ̂ touches its σ_t nowhere where that of another channel does not,
/// and, where walks scatter, its σ_t is 0 nowhere where that of another is not.
///
/// # Errors
///
/// The channel and the place, and whether the draws are biased or their variance is infinite.
pub fn require_room(channels: &[SpectralChannel], scatters: bool) -> Result<(), Refusal> {
    let real = |own: &SpectralChannel, t: f64| own.mesh.medium().extinction(t) / own.majorant;
    let null = |own: &SpectralChannel, t: f64| 1.0 - real(own, t);
    for (number, hero) in channels.iter().enumerate() {
        let majorant = rounded(hero.majorant);
        let room = Room {
            share: &null,
            // They are differences: what is left of them is rounding.
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

/// What a hero must have wherever another channel has it.
struct Room<'a> {
    /// Its share of collisions at a distance.
    share: &'a dyn Fn(&SpectralChannel, f64) -> f64,
    /// A share up to this is none.
    none: f64,
    needs: &'static str,
    /// What is said where it is missing on a stretch, and at a distance.
    stretch: String,
    touch: String,
}

impl Room<'_> {
    /// The hero's share over that of the channel that has most beside it; 1 where no other has any.
    fn beside(&self, channels: &[SpectralChannel], number: usize, t: f64) -> f64 {
        let share = |channel: &SpectralChannel| (self.share)(channel, t);
        let most = channels.iter().map(share).fold(0.0, f64::max);
        if most > self.none { share(&channels[number]) / most } else { 1.0 }
    }

    fn require(&self, channels: &[SpectralChannel], number: usize) -> Result<(), Refusal> {
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
            let found =
                format!("{stretch} in channel {number} on a stretch, which biases the others,");
            return Err(Refusal::Inequality { needs, found, at: panel.span.from });
        }
        let touches = cut.peaks(|t| -beside(t)).into_iter().find(|&(_, found)| -found <= TOUCHES);
        if let Some((at, _)) = touches {
            let found = format!("{touch} in channel {number}: E[X²] is infinite");
            return Err(Refusal::Inequality { needs: "a finite variance", found, at });
        }
        Ok(())
    }
}

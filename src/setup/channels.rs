//! What σ̂ must be where several channels (wavelengths) are scored by one walk.

use super::{Refusal, SpectralChannel};
use crate::catalogue::rounded;

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

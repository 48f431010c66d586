//! Walks into a furnace in several channels, all of them by one draw.

pub mod independent;
pub mod packet;
pub mod page;
pub mod spectral_mis;
pub mod walk;

use crate::catalogue::rounded;
use crate::estimators::{Refusal, Setup, estimators};
use crate::geometry::Bounds;
use crate::problems::SpectralFurnace;
use crate::setup::channels;
use crate::setup::heroes::Heroes;

/// More collisions than this straight through the volume are a mistake in the case.
const MOST_COLLISIONS: f64 = 1e4;
/// Bounds on σ_t are raised by a share like this, because lookups are rounded.
const SLACK: f64 = 1e-9;

/// One hero probability and a constant σ̂ ≥ σ_t for each channel, everywhere in the volume.
fn realisable(setup: &Setup<SpectralFurnace>, heroes: &Heroes) -> Result<(), Refusal> {
    heroes.require(setup.channels.len())?;
    channels::require_constants(&setup.channels)?;
    let across = match setup.problem.bounds {
        Bounds::Everywhere => f64::INFINITY,
        Bounds::Sphere { radius, .. } => 2.0 * radius,
        Bounds::Box(within) => (within.high - within.low).norm(),
    };
    let within = setup.problem.bounds.enclosing_box();
    let channels = setup.channels.iter().zip(&setup.problem.channels);
    for (number, (channel, medium)) in (1..).zip(channels) {
        let most = within.map_or(f64::INFINITY, |within| medium.volume.majorant(&within));
        if most > channel.majorant * (1.0 + SLACK) {
            let [majorant, most] = [channel.majorant, most].map(rounded);
            let found = format!("σ̂ = {majorant} and σ_t is bounded by {most} in channel {number}");
            return Err(Refusal::mismatch("σ̂ ≥ σ_t everywhere in the volume", found));
        }
        let collisions = channel.majorant * across;
        if collisions.is_nan() || collisions > MOST_COLLISIONS {
            let found = format!("it may be {collisions:e} in channel {number}");
            return Err(Refusal::mismatch("∫σ̂ ≤ 1e4 straight through the volume", found));
        }
    }
    Ok(())
}

estimators! {
    SpectralFurnace:
    independent::Independent,
    spectral_mis::SpectralMis,
}

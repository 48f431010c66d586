//! Estimators of single scattering of a point light in several channels, all of them by one draw.

pub mod independent;
pub mod packet;
pub mod page;
pub mod spectral_mis;
pub mod walk;

use crate::catalogue::{Settings, rounded};
use crate::estimators::single_scattering::delta_tracking::{Absorption, DeltaTracking};
use crate::estimators::{Refusal, Setup, estimators};
use crate::media::Control;
use crate::problems::SpectralSingleScattering;
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::theory::single::{Points, Tracking};

/// How shadow rays are tracked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadow {
    /// Their transmittance is known.
    Exact,
    /// By ratio tracking through the σ̂ of the hero.
    Ratio,
}

impl Shadow {
    fn read(settings: &Settings) -> Option<Self> {
        let word = settings.word_or("shadow", &["exact", "ratio"], "exact")?;
        Some(if word == "ratio" { Self::Ratio } else { Self::Exact })
    }

    fn label(self, heroes: &Heroes) -> String {
        let words = if self == Self::Ratio { "ratio shadow" } else { "exact shadow" };
        let heroes = heroes.label();
        if heroes.is_empty() { words.into() } else { format!("{words}, {heroes}") }
    }
}

/// One hero probability and a constant σ̂ ≥ σ_t for each channel, on the ray and on shadow rays that are tracked.
fn realisable(
    setup: &Setup<SpectralSingleScattering>,
    heroes: &Heroes,
    shadow: Shadow,
) -> Result<(), Refusal> {
    heroes.require(setup.channels.len())?;
    channels::require_constants(&setup.channels)?;
    channels::require_majorants(&setup.channels)?;
    if shadow == Shadow::Exact {
        return Ok(());
    }
    for (number, (channel, lit)) in (1..).zip(setup.channels.iter().zip(&setup.problem.channels)) {
        let bound = lit.shadow_majorant();
        if channel.majorant < bound * (1.0 - 1e-12) {
            let [majorant, bound] = [channel.majorant, bound].map(rounded);
            let found = format!("σ̂ = {majorant} and σ_t is bounded by {bound} in channel {number}");
            return Err(Refusal::mismatch("σ̂ ≥ σ_t on every shadow ray", found));
        }
    }
    Ok(())
}

/// The moments of analog tracking of each channel by itself.
fn alone(setup: &Setup<SpectralSingleScattering>, shadow: Shadow) -> Vec<Points> {
    let each = setup.channels.iter().zip(&setup.problem.channels);
    let points = each.map(|(channel, problem)| {
        let shadow = match shadow {
            Shadow::Exact => Tracking::Exact,
            Shadow::Ratio => Tracking::Ratio { sampling: channel.majorant, control: 0.0 },
        };
        let (mesh, sampling) = (channel.mesh.clone(), Some(channel.sampling.clone()));
        let own = Setup::new(problem.clone(), mesh, sampling, Control::None);
        DeltaTracking { absorption: Absorption::Analog, shadow }.points(&own)
    });
    points.collect()
}

estimators! {
    SpectralSingleScattering:
    independent::Independent,
    spectral_mis::SpectralMis,
}

//! Estimators of single scattering of a point light in several channels, all of them by one draw.

pub mod events;
pub mod hero;
pub mod independent;
pub mod page;
pub mod spectral_mis;
pub mod spectral_tracking;
pub mod walk;

use crate::setup::ControlledLine;
use crate::setup::heroes::Heroes;
use crate::setup::walker::Walker;
use crate::single_scattering::plan::{Absorption, at_collisions};
use crate::{Knowledge, Refusal, Setup, estimators};
use ::theory::Prediction;
use ::theory::colours::Chances;
use ::theory::colours::rates::Proposal;
use ::theory::problems::SpectralSingleScattering;
use ::theory::single::spectral as theory;
use ::theory::single::spectral::relative::Relative;
use ::theory::single::{TechniqueMoments, Tracking};
use media::Control;
use media::catalogue::Settings;
use numeric::digits::rounded;

/// Tracking of shadow rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shadow {
    /// Exact transmittance.
    Exact,
    /// Ratio tracking through the σ̂ of the hero.
    Ratio,
}

impl Shadow {
    fn read(settings: &Settings) -> Option<Self> {
        let word = settings.word_or("shadow", &["exact", "ratio"], "exact")?;
        Some(if word == "ratio" { Self::Ratio } else { Self::Exact })
    }

    fn needs(self) -> Option<Knowledge> {
        (self == Self::Exact).then_some(Knowledge::OpticalDepth)
    }

    fn label(self, further: &str) -> String {
        let words = if self == Self::Ratio { "ratio shadow" } else { "exact shadow" };
        if further.is_empty() { words.into() } else { format!("{words}, {further}") }
    }
}

/// Checks σ̂ ≥ σ_t on every shadow ray that is tracked.
fn realisable(setup: &Setup<SpectralSingleScattering>, shadow: Shadow) -> Result<(), Refusal> {
    if shadow == Shadow::Exact {
        return Ok(());
    }
    for (number, (channel, lit)) in (1..).zip(setup.fields.iter().zip(&setup.problem.channels)) {
        let bound = lit.shadow_majorant();
        if channel.majorant < bound * (1.0 - 1e-12) {
            let [majorant, bound] = [channel.majorant, bound].map(rounded);
            let actual =
                format!("σ̂ = {majorant} and σ_t is bounded by {bound} in channel {number}");
            return Err(Refusal::mismatch("σ̂ ≥ σ_t on every shadow ray", actual));
        }
    }
    Ok(())
}

/// The moments of analog tracking of each channel by itself.
fn alone(setup: &Setup<SpectralSingleScattering>, shadow: Shadow) -> Vec<TechniqueMoments> {
    let each = setup.fields.iter().zip(&setup.problem.channels);
    let points = each.map(|(channel, problem)| {
        let shadow = match shadow {
            Shadow::Exact => Tracking::Exact,
            Shadow::Ratio => Tracking::Ratio { sampling: channel.majorant, control: 0.0 },
        };
        let part = (channel.mesh.clone(), Some(channel.sampling.clone()));
        let fields = ControlledLine::new(&**problem, part, Control::None);
        let own = Setup { problem: problem.clone(), fields, distributions: false };
        at_collisions(&own, Absorption::Analog, shadow)
    });
    points.collect()
}

/// Prediction of draws that score one channel.
fn predict_independent(
    setup: &Setup<SpectralSingleScattering>,
    walker: &Walker,
    shadow: Shadow,
) -> Prediction {
    let heroes = walker.heroes().unwrap_or(&Heroes::Uniform);
    theory::independent(&alone(setup, shadow), &heroes.of(setup.fields.len()))
}

/// Prediction of draws that score all channels.
fn predict(setup: &Setup<SpectralSingleScattering>, walker: &Walker, shadow: Shadow) -> Prediction {
    let (alone, count) = (alone(setup, shadow), setup.fields.len());
    let walks = match walker {
        Walker::Mis(heroes) => return theory::balanced(&alone, &heroes.of(count)),
        // Its scores are those of the balance heuristic with equal heroes, and its walks are the same.
        Walker::SpectralTracking(Chances::History) => {
            return theory::balanced(&alone, &Heroes::Uniform.of(count));
        }
        Walker::SpectralTracking(Chances::Fixed(probability)) => {
            vec![(1.0, Proposal::Together(*probability))]
        }
        Walker::Hero(heroes) => {
            heroes.of(count).into_iter().enumerate().map(|(h, w)| (w, Proposal::Hero(h))).collect()
        }
    };
    let of_heroes = walker.heroes().and_then(|heroes| theory::lookups(&alone, &heroes.of(count)));
    let media = setup.fields.iter().map(|channel| (&*channel.mesh, channel.majorant)).collect();
    let tracks = shadow == Shadow::Ratio;
    Relative::new(&setup.problem.channels, media, setup.residual().sampling, walks, tracks)
        .predict(&alone, of_heroes)
}

estimators! {
    SpectralSingleScattering on ChannelMedia:
    independent::Independent,
    hero::Hero,
    spectral_tracking::SpectralTracking,
    spectral_mis::SpectralMis,
}

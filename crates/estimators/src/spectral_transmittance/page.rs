//! The page of all trackers: their settings, domain, prediction and draws.

use super::events::Right;
use super::walk::{AlongRay, spectrum};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::setup::walker::{HERO, INDEPENDENT, SPECTRAL_TRACKING, read_chances};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits, walks};
use media::catalogue::Settings;
use theory::Prediction;
use theory::colours::Chances;
use theory::problems::SpectralTransmittance;
use theory::ray::spectral::Tracker;

/// Kind of [`super::common_ratio`].
pub const COMMON_RATIO: u8 = 4;

/// A tracker of a kind.
#[derive(Debug, Clone)]
pub struct OfKind<const KIND: u8> {
    tracker: Tracker,
    /// Distribution of the hero; `None` where all channels walk together through one σ̂.
    heroes: Option<Heroes>,
    /// Label of the settings.
    label: String,
}

impl<const KIND: u8> OfKind<KIND> {
    /// A tracker of all channels together.
    fn together(tracker: Tracker, label: &str) -> Self {
        Self { tracker, heroes: None, label: label.to_owned() }
    }

    /// Reads the settings of a tracker with a hero.
    fn read_hero(settings: &Settings) -> Option<Self> {
        let delta = settings.word_or("collisions", &["ratio", "delta"], "ratio");
        let in_turn = match KIND {
            INDEPENDENT => settings.word_or("channels", &["one", "all"], "one"),
            _ => Some("one"),
        };
        let heroes = Heroes::read(settings);
        let (word, in_turn, heroes) = (delta?, in_turn? == "all", heroes?);
        let delta = word == "delta";
        let tracker = match KIND {
            INDEPENDENT if in_turn => Tracker::InTurn { delta },
            INDEPENDENT => Tracker::Independent { delta },
            HERO => Tracker::Hero { delta },
            _ => Tracker::Mis { delta },
        };
        let further = if in_turn { "all channels in turn".to_owned() } else { heroes.label() };
        let label = if further.is_empty() { word.into() } else { format!("{word}, {further}") };
        Some(Self { tracker, heroes: Some(heroes), label })
    }

    /// The walk, for draws.
    fn walk<'a>(&'a self, setup: &'a Setup<SpectralTransmittance>) -> AlongRay<'a, Right> {
        match &self.heroes {
            Some(heroes) => AlongRay::new(setup, heroes, self.tracker, Right),
            None => AlongRay::common(setup, &Heroes::Uniform, self.tracker, Right),
        }
    }
}

impl<const KIND: u8> Estimator<SpectralTransmittance> for OfKind<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        match KIND {
            SPECTRAL_TRACKING => {
                let chances = read_chances(settings)?;
                let tracker = match chances {
                    Chances::Fixed(probability) => Tracker::Tracking(probability),
                    // Weights that remember are those of the balance heuristic.
                    Chances::History => Tracker::Mis { delta: true },
                };
                Some(Self::together(tracker, chances.label()))
            }
            COMMON_RATIO => Some(Self::together(Tracker::Hero { delta: false }, "")),
            _ => Self::read_hero(settings),
        }
    }

    fn traits(&self) -> Traits {
        Traits { settings: self.label.clone(), ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
        match &self.heroes {
            Some(heroes) => heroes.require(setup.fields.len())?,
            None => channels::require_common(&setup.fields)?,
        }
        if self.tracker.is_delta() {
            channels::require_majorants(&setup.fields)?;
        }
        if matches!(self.tracker, Tracker::Hero { delta: true }) {
            channels::require_room(&setup.fields, false)?;
        }
        Ok(())
    }

    fn predict(&self, setup: &Setup<SpectralTransmittance>) -> Prediction {
        let heroes = self.heroes.as_ref().unwrap_or(&Heroes::Uniform);
        spectrum(setup, heroes, self.tracker).predict(&setup.problem.luminance)
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<SpectralTransmittance>, request: Request) {
        walks::fill(&self.walk(setup), kernel, setup, request);
    }
}

//! The page of the balance heuristic over heroes, of hits alone or of hits and shadow rays.

use super::events::WalkEvents;
use super::pages;
use crate::setup::heroes::Heroes;
use crate::{Estimator, Inputs, Traits};
use media::catalogue::Settings;
use theory::problems::SpectralLitRod;
use theory::rod::lit::spectral::LitTracker;

/// The balance heuristic over heroes; with `CASTS` walks cast shadow rays.
#[derive(Debug, Clone)]
pub struct HeroMis<const CASTS: bool> {
    /// Distribution of the hero.
    pub heroes: Heroes,
}

impl<const CASTS: bool> WalkEvents for HeroMis<CASTS> {
    #[inline(always)]
    fn heroes(&self) -> &Heroes {
        &self.heroes
    }

    #[inline(always)]
    fn has_shadow_rays(&self) -> bool {
        CASTS
    }
}

impl<const CASTS: bool> Estimator<SpectralLitRod> for HeroMis<CASTS> {
    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { heroes: Heroes::read(settings)? })
    }

    fn traits(&self) -> Traits {
        Traits { settings: self.heroes.label(), ..Traits::of(Inputs::SAMPLING) }
    }

    pages!(self => self.heroes, LitTracker::Mis { casts: CASTS });
}

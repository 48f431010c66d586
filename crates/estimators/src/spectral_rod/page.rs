//! The page of all estimators of coloured scatterers: their settings, weights, domain, prediction and draws.

use super::{Coloured, walk};
use crate::setup::heroes::Heroes;
use crate::setup::walker::{HERO, INDEPENDENT, MIS, SPECTRAL_TRACKING};
use crate::{Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::body::MAX_CHANNELS;
use media::catalogue::Settings;
use theory::Prediction;
use theory::colours::scatterers::{BodySpectrum, BodyTracker};

/// Walk of a hero, or of all channels together by one probability to be scattered.
#[derive(Debug, Clone)]
pub enum HeroOrJoint {
    /// The hero, by its distribution.
    Hero(Heroes),
    /// All channels: by the largest albedo and the largest share of absorption, or by the mean albedo.
    Together {
        /// True for the largest albedo, false for the mean albedo.
        maximum: bool,
    },
}

/// An estimator of a kind.
#[derive(Debug, Clone)]
pub struct OfKind<const KIND: u8>(pub HeroOrJoint);

/// `P_s`, the probability to be scattered of all channels together.
#[inline(always)]
fn scatter(albedos: &[f64], maximum: bool) -> f64 {
    if maximum {
        let largest = albedos.iter().fold(0.0f64, |largest, &a| largest.max(a));
        let minimum = albedos.iter().fold(1.0f64, |minimum, &a| minimum.min(a));
        largest / (largest + (1.0 - minimum))
    } else {
        albedos.iter().sum::<f64>() / albedos.len() as f64
    }
}

impl<const KIND: u8> walk::HeroWeights for OfKind<KIND> {
    #[inline(always)]
    fn heroes(&self) -> Option<&Heroes> {
        if let HeroOrJoint::Hero(heroes) = &self.0 { Some(heroes) } else { None }
    }

    #[inline(always)]
    fn probability(&self, albedos: &[f64], hero: usize) -> f64 {
        match self.0 {
            HeroOrJoint::Hero(_) => albedos[hero],
            HeroOrJoint::Together { maximum } => scatter(albedos, maximum),
        }
    }

    #[inline(always)]
    fn weights(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MAX_CHANNELS] {
        let count = albedos.len();
        let heroes = match &self.0 {
            HeroOrJoint::Hero(heroes) => heroes,
            HeroOrJoint::Together { maximum } => {
                return walk::relative_to(albedos, scatter(albedos, *maximum), order);
            }
        };
        if KIND == INDEPENDENT {
            let mut weights = [0.0; MAX_CHANNELS];
            weights[hero] = 1.0 / heroes.probability(count, hero);
            return weights;
        }
        let mut weights = walk::relative_to(albedos, albedos[hero], order);
        if KIND == MIS {
            let mut density = 0.0;
            for (channel, weight) in weights[..count].iter().enumerate() {
                density += heroes.probability(count, channel) * weight;
            }
            for weight in &mut weights[..count] {
                *weight /= density;
            }
        }
        weights
    }
}

impl<const KIND: u8> OfKind<KIND> {
    /// The distribution of the hero: of all channels together theory takes equal heroes.
    fn distribution(&self) -> &Heroes {
        if let HeroOrJoint::Hero(heroes) = &self.0 { heroes } else { &Heroes::Uniform }
    }

    /// The spectrum of a setup, for predictions.
    fn spectrum<'a, P: Coloured>(&self, setup: &'a Setup<P>) -> BodySpectrum<'a> {
        let colours = setup.problem.colours();
        let tracker = match self.0 {
            HeroOrJoint::Together { maximum } => {
                BodyTracker::Tracking { scatter: scatter(&colours.albedos, maximum) }
            }
            HeroOrJoint::Hero(_) if KIND == INDEPENDENT => BodyTracker::Independent,
            HeroOrJoint::Hero(_) if KIND == HERO => BodyTracker::Hero,
            HeroOrJoint::Hero(_) => BodyTracker::Mis,
        };
        BodySpectrum::new(
            P::body(setup),
            colours,
            self.distribution().of(colours.albedos.len()),
            tracker,
        )
    }
}

impl<P: Coloured, const KIND: u8> Estimator<P> for OfKind<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        if KIND != SPECTRAL_TRACKING {
            return Some(Self(HeroOrJoint::Hero(Heroes::read(settings)?)));
        }
        let word = settings.word_or("probabilities", &["average", "maximum"], "average")?;
        Some(Self(HeroOrJoint::Together { maximum: word == "maximum" }))
    }

    fn traits(&self) -> Traits {
        let settings = match &self.0 {
            HeroOrJoint::Hero(heroes) => heroes.label(),
            HeroOrJoint::Together { maximum: true } => "maximum".into(),
            HeroOrJoint::Together { maximum: false } => "average".into(),
        };
        Traits { settings, ..Traits::of(Inputs::SAMPLING) }
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        walk::require(setup, self.distribution())?;
        if KIND == HERO {
            walk::require_scattering(&setup.problem.colours().albedos, self.distribution())?;
        }
        if KIND == HERO || KIND == SPECTRAL_TRACKING {
            walk::require_variance(self.spectrum(setup).divergence())?;
        }
        Ok(())
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        self.spectrum(setup).predict()
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<P>, request: Request) {
        walk::fill(self, kernel, setup, request);
    }
}

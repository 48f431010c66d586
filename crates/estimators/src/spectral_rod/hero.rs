//! The analog walk of one hero scores all channels, divided by the hero's density alone.
//!
//! Unbiased for: σ̂ ≥ σ_t, as long as the variance is finite; refused elsewhere.
//!
//! ```text
//! X_λ = (a_λ/a_h)^r where it leaves after r scatterings,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Unbiased where the albedos of all heroes are positive, or all are 0. The variance of a channel is infinite where
//! `a_λ²/a_h` is the albedo of a rod beyond its critical length: refused from there on. Multiple importance
//! sampling solves this: see `spectral-mis`. A finite variance may still be out of reach of any number of draws:
//! the fourth moment needs `a_λ⁴/a_h³`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1; the moments are derived: see the theory of coloured
//! bodies.

use super::{Coloured, scored, spectrum, walk};
use crate::setup::heroes::Heroes;
use crate::{Estimator, Refusal, Setup};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use theory::Prediction;
use theory::spectral_rod::{Spectrum, Tracker};

/// A single hero, without multiple importance sampling.
#[derive(Debug, Clone)]
pub struct Hero {
    heroes: Heroes,
}

impl Hero {
    fn spectrum<'a, P: Coloured>(&self, setup: &'a Setup<P>) -> Spectrum<'a> {
        let count = setup.problem.colours().albedos.len();
        spectrum(setup, self.heroes.of(count), Tracker::Hero)
    }
}

impl walk::Page for Hero {
    #[inline(always)]
    fn heroes(&self) -> Option<&Heroes> {
        Some(&self.heroes)
    }

    #[inline(always)]
    fn weights(&self, albedos: &[f64], hero: usize, order: u32) -> [f64; MOST_CHANNELS] {
        walk::relative(albedos, hero, order)
    }
}

impl<P: Coloured> Estimator<P> for Hero {
    scored!();

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { heroes: Heroes::read(settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.heroes.label()
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        walk::require(setup, &self.heroes)?;
        let albedos = &setup.problem.colours().albedos;
        let scatters = albedos.iter().any(|&albedo| albedo > 0.0);
        let lost = (0..albedos.len()).find(|&hero| {
            scatters && albedos[hero] == 0.0 && self.heroes.probability(albedos.len(), hero) > 0.0
        });
        if let Some(hero) = lost {
            let found = format!("the albedo of channel {} is 0, which biases the others", hero + 1);
            return Err(Refusal::mismatch("heroes that scatter where another channel does", found));
        }
        walk::require_variance(self.spectrum(setup).diverges())
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        self.spectrum(setup).predict()
    }
}

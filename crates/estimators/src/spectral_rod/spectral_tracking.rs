//! Spectral tracking in a rod: one scattering probability for all channels.
//!
//! Unbiased for: σ̂ ≥ σ_t, as long as the variance is finite; refused elsewhere.
//!
//! ```text
//! a real collision scatters with P_s, then w_λ ← w_λ a_λ/P_s;  X_λ = w_λ where it leaves
//! average  P_s = mean a        maximum  P_s = a_max/(a_max + (1 − a)_max)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"` or `"maximum"` | `"average"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Null collisions are the same in all channels and are decided first. Unbiased everywhere, but the variance of a
//! channel is infinite where `a_λ²/P_s` is the albedo of a rod beyond its critical length: refused from there on. A
//! finite variance may still be out of reach of any number of draws: the fourth moment needs `a_λ⁴/P_s³`.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5.1.

use super::{Coloured, scored, spectrum, walk};
use crate::setup::heroes::Heroes;
use crate::{Estimator, Refusal, Setup};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use theory::Prediction;
use theory::spectral_rod::{Spectrum, Tracker};

/// Spectral tracking.
#[derive(Debug, Clone)]
pub struct SpectralTracking {
    /// True if `P_s` is computed from the largest shares, false if from the mean.
    pub maximum: bool,
}

impl SpectralTracking {
    /// `P_s`.
    #[inline(always)]
    fn scatter(&self, albedos: &[f64]) -> f64 {
        if self.maximum {
            let most = albedos.iter().fold(0.0f64, |most, &a| most.max(a));
            let least = albedos.iter().fold(1.0f64, |least, &a| least.min(a));
            most / (most + (1.0 - least))
        } else {
            albedos.iter().sum::<f64>() / albedos.len() as f64
        }
    }

    fn spectrum<'a, P: Coloured>(&self, setup: &'a Setup<P>) -> Spectrum<'a> {
        let albedos = &setup.problem.colours().albedos;
        let tracker = Tracker::Tracking { scatter: self.scatter(albedos) };
        spectrum(setup, Heroes::Uniform.of(albedos.len()), tracker)
    }
}

impl walk::Page for SpectralTracking {
    #[inline(always)]
    fn heroes(&self) -> Option<&Heroes> {
        None
    }

    #[inline(always)]
    fn chance(&self, albedos: &[f64], _: usize) -> f64 {
        self.scatter(albedos)
    }

    #[inline(always)]
    fn weights(&self, albedos: &[f64], _: usize, order: u32) -> [f64; MOST_CHANNELS] {
        let scatter = self.scatter(albedos);
        let mut weights = [1.0; MOST_CHANNELS];
        for _ in 0..order {
            for (weight, albedo) in weights.iter_mut().zip(albedos) {
                *weight *= albedo / scatter;
            }
        }
        weights
    }
}

impl<P: Coloured> Estimator<P> for SpectralTracking {
    scored!();

    fn read(settings: &Settings) -> Option<Self> {
        let word = settings.word_or("probabilities", &["average", "maximum"], "average")?;
        Some(Self { maximum: word == "maximum" })
    }

    fn label(&self, _: bool) -> String {
        if self.maximum { "maximum".into() } else { "average".into() }
    }

    fn domain(&self, setup: &Setup<P>) -> Result<(), Refusal> {
        walk::require(setup, &Heroes::Uniform)?;
        walk::require_variance(self.spectrum(setup).diverges())
    }

    fn predict(&self, setup: &Setup<P>) -> Prediction {
        self.spectrum(setup).predict()
    }
}

//! Spectral tracking in a rod: one chance to be scattered for all channels.
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

use super::{Coloured, spectrum, walk};
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::spectral_rod::Values;
use crate::rng::Stream;
use crate::setup::heroes::Heroes;
use crate::theory::Prediction;
use crate::theory::spectral_rod::{Spectrum, Tracker};

/// Spectral tracking.
#[derive(Debug, Clone)]
pub struct SpectralTracking {
    maximum: bool,
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

impl<P: Coloured> Estimator<P> for SpectralTracking {
    const INPUTS: Inputs = Inputs::SAMPLING;

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

    #[inline(always)]
    fn draw(&self, setup: &Setup<P>, medium: &Lookups, rng: &mut Stream) -> Draw<Values> {
        let colours = setup.problem.colours();
        let scatter = self.scatter(&colours.albedos);
        let left = P::walk(setup, medium, rng, scatter);
        let mut weights = [1.0; MOST_CHANNELS];
        for _ in 0..left.order {
            for (weight, albedo) in weights.iter_mut().zip(&colours.albedos) {
                *weight *= albedo / scatter;
            }
        }
        Draw::free(colours.values(left.end, &weights), left.lookups)
    }
}

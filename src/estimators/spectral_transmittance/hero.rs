//! The walk of one hero channel scores all channels, divided by the hero's density alone.
//!
//! ```text
//! X_λ = f_λ/p_h,  h of probability w_h,  f and p as in the walk
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `collisions` | `"ratio"` or `"delta"` | `"ratio"` |
//! | `hero` | the law of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel; at least σ_t for `"delta"` | required here or in the case |
//!
//! With delta tracking the variance is infinite where the hero's σ̂ touches its σ_t and another channel's does
//! not, and the draws are biased where it does so on a stretch: both are refused. What multiple importance
//! sampling is for: see `spectral-mis`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.

use fearless_simd::Level;

use super::walk;
use crate::catalogue::{Settings, rounded};
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::kernels::packet::Request;
use crate::kernels::packet::spectral::{self as packet, Rule};
use crate::media::Lookups;
use crate::media::body::MOST_CHANNELS;
use crate::problems::SpectralTransmittance;
use crate::problems::spectral_transmittance::Values;
use crate::rng::Stream;
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::theory::Prediction;
use crate::theory::spectral::Tracker;

/// A null extinction below this share of σ̂ is none.
const TOUCHES: f64 = 1e-9;

/// One hero, without multiple importance sampling.
#[derive(Debug, Clone)]
pub struct Hero {
    delta: bool,
    heroes: Heroes,
}

impl Estimator<SpectralTransmittance> for Hero {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        let (delta, heroes) = (walk::read_delta(settings), Heroes::read(settings));
        Some(Self { delta: delta?, heroes: heroes? })
    }

    fn label(&self, _: bool) -> String {
        walk::label(self.delta, &self.heroes.label())
    }

    fn domain(&self, setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
        self.heroes.require(setup.channels.len())?;
        channels::require_constants(&setup.channels)?;
        if self.delta {
            channels::require_majorants(&setup.channels)?;
            require_room(setup)?;
        }
        Ok(())
    }

    fn predict(&self, setup: &Setup<SpectralTransmittance>) -> Prediction {
        let tracker = Tracker::Hero { delta: self.delta };
        walk::spectrum(setup, &self.heroes, tracker).predict(&setup.problem.luminance)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let count = setup.channels.len();
        let hero = self.heroes.choose(setup.channels.len(), rng.uniform());
        let passed = walk::walk(setup, medium, rng, (hero, self.delta), 0..count);
        let mut found = [0.0; MOST_CHANNELS];
        if passed.is_alive {
            let density = if self.delta { passed.ratios[hero] } else { 1.0 };
            for (channel, found) in found[..count].iter_mut().enumerate() {
                let relative = walk::relative_density(setup, channel, hero, passed.lookups);
                *found = relative * passed.ratios[channel] / density;
            }
        }
        Draw::free(setup.problem.values(&found[..count]), passed.lookups)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let tracker = Tracker::Hero { delta: self.delta };
        let rule = Rule { tracker, is_common: false, heroes: &self.heroes };
        packet::walks(level, setup, rule, medium, request)
    }
}

/// No hero's σ̂ touches its σ_t where that of another channel does not.
///
/// # Errors
///
/// The channel and the place, and whether the draws are biased or their variance is infinite.
fn require_room(setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
    let channels = &setup.channels;
    for (number, hero) in (1..).zip(channels) {
        let null = |own: &crate::setup::SpectralChannel, t: f64| {
            1.0 - own.mesh.medium().extinction(t) / own.majorant
        };
        let is_open = |t: f64| channels.iter().any(|other| null(other, t) > TOUCHES);
        let cuts: Vec<f64> =
            channels.iter().flat_map(|c| c.mesh.panels().map(|panel| panel.span.from)).collect();
        let cut = hero.mesh.refined(&cuts, &|_, _| Vec::new());
        // Touched at every node of a panel: on a stretch.
        let stretch = cut.panels().find(|panel| {
            panel.t.iter().all(|&t| null(hero, t) <= TOUCHES) && is_open(panel.span.middle())
        });
        let majorant = rounded(hero.majorant);
        if let Some(panel) = stretch {
            return Err(Refusal::Inequality {
                needs: "σ̂ > σ_t of the hero wherever another channel has null collisions",
                found: format!(
                    "σ̂ = σ_t = {majorant} in channel {number} on a stretch, which biases the others,"
                ),
                at: panel.span.from,
            });
        }
        let touched = cut
            .largest(|_, sigma| sigma)
            .filter(|&(at, sigma)| sigma >= hero.majorant * (1.0 - TOUCHES) && is_open(at));
        if let Some((at, _)) = touched {
            return Err(Refusal::Inequality {
                needs: "a finite variance",
                found: format!("σ̂ = {majorant} touches σ_t in channel {number}: E[X²] is infinite"),
                at,
            });
        }
    }
    Ok(())
}

//! Spectral tracking: one σ̂ for all channels, and a chance of null collisions that depends on all of them.
//!
//! Unbiased for: one constant σ̂ ≥ σ_t for all channels; refused elsewhere.
//!
//! ```text
//! at a collision null with P_n, then w_λ ← w_λ (n_λ/μ̄)/P_n;  else real, and X = 0;   X_λ = w_λ at the end
//! average  P_n = mean_λ n_λ/μ̄
//! maximum  P_n = max n/(max n + max σ)
//! history  P_n = Σ |w_λ n_λ| / (Σ |w_λ n_λ| + Σ |w_λ σ_λ|)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"`, `"maximum"` or `"history"` | `"average"` |
//! | `sampling` | one constant σ̂ for all channels, at least the σ_t of each | required here or in the case |
//!
//! Unbiased there. The history-aware form scores what `spectral-mis` with delta tracking, one σ̂ and equal
//! probabilities scores.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), sections 5.1.1 and 5.1.2.

use fearless_simd::Level;

use super::walk;
use crate::kernels::packet::Request;
use crate::kernels::packet::spectral::{self as packet, Rule};
use crate::setup::channels;
use crate::setup::heroes::Heroes;
use crate::setup::walker::read_chances;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::body::MOST_CHANNELS;
use media::catalogue::Settings;
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SpectralTransmittance;
use theory::problems::spectral_transmittance::Values;
use theory::spectral::{Chances, Tracker};

/// Spectral tracking.
#[derive(Debug, Clone)]
pub struct SpectralTracking {
    chances: Chances,
}

impl SpectralTracking {
    /// For theory, and for packets.
    fn tracker(&self) -> Tracker {
        match self.chances {
            Chances::Fixed(chance) => Tracker::Tracking(chance),
            // Weights that remember are those of the balance heuristic.
            Chances::History => Tracker::Mis { delta: true },
        }
    }
}

impl Estimator<SpectralTransmittance> for SpectralTracking {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { chances: read_chances(settings)? })
    }

    fn label(&self, _: bool) -> String {
        self.chances.label().into()
    }

    fn domain(&self, setup: &Setup<SpectralTransmittance>) -> Result<(), Refusal> {
        channels::require_constants(&setup.channels)?;
        channels::require_common(&setup.channels)?;
        channels::require_majorants(&setup.channels)
    }

    fn predict(&self, setup: &Setup<SpectralTransmittance>) -> Prediction {
        walk::spectrum(setup, &Heroes::Uniform, self.tracker()).predict(&setup.problem.luminance)
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<Values> {
        let count = setup.channels.len();
        let common = &setup.channels[0];
        let mut cursor = common.sampling.begin();
        let (mut weights, mut shares) = ([1.0; MOST_CHANNELS], [0.0; MOST_CHANNELS]);
        let (weights, shares) = (&mut weights[..count], &mut shares[..count]);
        let mut lookups = 0;
        loop {
            let (depth, number) = (-rng.ln_uniform(), rng.uniform());
            if common.sampling.fly(&mut cursor, depth).is_none() {
                return Draw::free(setup.problem.values(weights), lookups);
            }
            lookups += 1;
            for (channel, share) in shares.iter_mut().enumerate() {
                let extinction = medium.channel(channel).extinction(cursor.t);
                *share = 1.0 - extinction / common.majorant;
            }
            let null = if let Chances::Fixed(chance) = self.chances {
                chance.of_null(shares)
            } else {
                let (mut nulls, mut all) = (0.0, 0.0);
                for (weight, share) in weights.iter().zip(shares.iter()) {
                    nulls += weight * share;
                    all += weight;
                }
                nulls / all
            };
            if number >= null {
                return Draw::free(setup.problem.values(&[0.0; MOST_CHANNELS][..count]), lookups);
            }
            for (weight, share) in weights.iter_mut().zip(shares.iter()) {
                *weight *= share / null;
            }
        }
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<SpectralTransmittance>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let rule = Rule { tracker: self.tracker(), is_common: true, heroes: &Heroes::Uniform };
        packet::walks(level, setup, rule, medium, request)
    }
}

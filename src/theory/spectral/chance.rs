//! The chances of spectral tracking: what a collision is, decided once for all channels.
//!
//! ```text
//! P_e = mean_λ μ_e,λ,   P_e ∝ max_λ μ_e,λ,   P_e ∝ Σ_λ w_λ μ_e,λ,   events e null, scattered, absorbed
//! ```
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), sections 5.1.1 and 5.1.2.

use crate::numeric::Lane;

/// How the next event of spectral tracking is chosen, whatever happened before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chance {
    /// In transmittance: `P_n` = mean over the channels of `n/μ̄`.
    Average,
    /// In transmittance: `P_n = max n/(max n + max σ)`.
    Maximum,
}

impl Chance {
    /// `P_n`, given `n/μ̄` of each channel.
    #[inline(always)]
    pub fn of_null(self, shares: &[f64]) -> f64 {
        match self {
            Self::Average => shares.iter().sum::<f64>() / shares.len() as f64,
            Self::Maximum => {
                let largest = shares.iter().fold(0.0f64, |most, &share| most.max(share));
                let least = shares.iter().fold(1.0f64, |least, &share| least.min(share));
                largest / (largest + (1.0 - least))
            }
        }
    }
}

/// The chances to be scattered, to go straight on and to be absorbed, given `σ_t/σ̂`, the albedo and the weight of each
/// channel; without a fixed chance they depend on the weights.
#[inline(always)]
pub fn of_events<L: Lane>(
    chance: Option<Chance>,
    ratios: &[L],
    albedos: &[f64],
    weights: &[L],
) -> [L; 3] {
    let (zero, one) = (ratios[0].each(0.0), ratios[0].each(1.0));
    let [mut scattered, mut null, mut absorbed] = [zero; 3];
    for channel in 0..ratios.len() {
        let (ratio, albedo) = (ratios[channel], one.each(albedos[channel]));
        let [scatters, passes, ends] = [ratio * albedo, one - ratio, ratio * (one - albedo)];
        match chance {
            Some(Chance::Average) => {
                scattered = scattered + scatters;
                null = null + passes;
                absorbed = absorbed + ends;
            }
            Some(Chance::Maximum) => {
                scattered = scattered.or_more(scatters);
                null = null.or_more(passes);
                absorbed = absorbed.or_more(ends);
            }
            None => {
                let weight = weights[channel];
                scattered = scattered + weight * scatters;
                null = null + weight * passes;
                absorbed = absorbed + weight * ends;
            }
        }
    }
    let sum = scattered + null + absorbed;
    [scattered / sum, null / sum, absorbed / sum]
}

//! Growth rates of the powers of all channels' weights along a walk that scores all of them.
//!
//! A walk has tentative collisions of rate μ̄. An event e (null, scattered) of probability `P_e` multiplies the
//! weight of the channel λ by `μ_e,λ/(μ̄ P_e)`. With `K = Σ k_λ`,
//!
//! ```text
//! E[Π X_λ^{k_λ}] of a stretch without scattering = exp(−A ℓ + ∫ N dt),   S the rate of scatterings
//! hero h               A = Σ k_λ μ̄_λ − (K − 1) μ̄_h,  N = Π n_λ^{k_λ}/n_h^{K−1},  S = Π μ_s,λ^{k_λ}/μ_s,h^{K−1}
//! spectral tracking    A = μ̄,  N = μ̄ Π (n_λ/μ̄)^{k_λ}/P_n^{K−1},  S = μ̄ Π (μ_s,λ/μ̄)^{k_λ}/P_s^{K−1}
//! ratio tracking       A as above,  N = Π n_λ^{k_λ}/μ̄_h^{K−1}
//! ```
//!
//! where lengths and rates of the hero's flights are in the weights, too. k = 0 gives probabilities of walks.
//!
//! Source: derived by Campbell's theorem, as in [`super`].

use super::probabilities::shares;
use super::{Chance, Chances};

/// Walker of a walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Proposal {
    /// The hero with a channel number.
    Hero(usize),
    /// All channels together, by fixed event probabilities.
    Together(Chance),
}

impl Proposal {
    /// Number of the channel with the σ̂ of the walk: of a hero, or any.
    fn number(self) -> usize {
        match self {
            Self::Hero(hero) => hero,
            Self::Together(_) => 0,
        }
    }
}

/// The channels of a medium.
#[derive(Debug, Clone)]
pub struct Rates {
    /// μ̄ of each.
    pub majorants: Vec<f64>,
    /// The albedo of each.
    pub albedos: Vec<f64>,
}

impl Rates {
    /// A of the exponents k.
    pub fn loss(&self, walk: Proposal, k: &[i32]) -> f64 {
        let total: i32 = k.iter().sum();
        let all: f64 = k.iter().zip(&self.majorants).map(|(&k, own)| f64::from(k) * own).sum();
        all - f64::from(total - 1) * self.majorants[walk.number()]
    }

    /// `A − N` of the square of a channel, given the extinctions of the channels, with all digits where these are
    /// small:
    ///
    /// ```text
    /// hero h               (2 μ̄_λ (σ_λ − σ_h) + μ̄_h σ_h − σ_λ² − (μ̄_λ − μ̄_h)²)/n_h,  σ_h for its own channel
    /// spectral tracking    μ̄ (r (2 − r) − (1 − P_n))/P_n,  r = σ_λ/μ̄
    /// ```
    pub fn lost_by_square(&self, walk: Proposal, channel: usize, extinctions: &[f64]) -> f64 {
        let (own, majorant) = (extinctions[channel], self.majorants[channel]);
        let is_null = own < majorant;
        match walk {
            Proposal::Hero(hero) if hero == channel => own,
            Proposal::Hero(hero) => {
                let (other, of_hero) = (extinctions[hero], self.majorants[walk.number()]);
                if !is_null {
                    return 2.0 * majorant - of_hero;
                }
                if other >= of_hero {
                    return f64::NEG_INFINITY;
                }
                let linear = 2.0 * majorant * (own - other) + of_hero * other;
                (linear - own * own - (majorant - of_hero).powi(2)) / (of_hero - other)
            }
            Proposal::Together(_) if !is_null => majorant,
            Proposal::Together(probability) => {
                let [null, scattered, absorbed] = self.chances(probability, extinctions);
                let ratio = own / majorant;
                majorant * (ratio * (2.0 - ratio) - (scattered + absorbed)) / null
            }
        }
    }

    /// N and S, given the extinctions of the channels.
    pub fn gains(&self, walk: Proposal, k: &[i32], extinctions: &[f64]) -> [f64; 2] {
        let majorants = &self.majorants;
        // Where σ_t exceeds σ̂ by rounding no collision is null.
        let null = |channel: usize| (majorants[channel] - extinctions[channel]).max(0.0);
        let scattered = |channel: usize| extinctions[channel] * self.albedos[channel];
        let [by_null, by_scattering] = match walk {
            Proposal::Hero(hero) => [null(hero), scattered(hero)],
            Proposal::Together(probability) => {
                let [null, scattered, _] = self.chances(probability, extinctions);
                [majorants[0] * null, majorants[0] * scattered]
            }
        };
        [product(k, null, by_null), product(k, scattered, by_scattering)]
    }

    /// Rate of absorption, as S is of scattering.
    pub fn absorbed(&self, walk: Proposal, k: &[i32], extinctions: &[f64]) -> f64 {
        let own = |channel: usize| extinctions[channel] * (1.0 - self.albedos[channel]);
        let by = match walk {
            Proposal::Hero(hero) => own(hero),
            Proposal::Together(probability) => {
                self.majorants[0] * self.chances(probability, extinctions)[2]
            }
        };
        product(k, own, by)
    }

    /// `P_n`, `P_s` and `P_a` of walks of all channels together.
    fn chances(&self, probability: Chance, extinctions: &[f64]) -> [f64; 3] {
        let of = |i: usize| shares(extinctions[i] / self.majorants[i], self.albedos[i]);
        Chances::Fixed(probability).of_events(extinctions.len(), of, extinctions)
    }

    /// N of ratio tracking through the walker's σ̂.
    pub fn gain_of_ratio(&self, walk: Proposal, k: &[i32], extinctions: &[f64]) -> f64 {
        product(
            k,
            |channel| self.majorants[channel] - extinctions[channel],
            self.majorants[walk.number()],
        )
    }
}

/// `Π x_λ^{k_λ}/by^{K−1}`; 0 where the event has the rate 0 in a channel with k > 0.
fn product(k: &[i32], of: impl Fn(usize) -> f64, by: f64) -> f64 {
    let mut result = 1.0;
    for (channel, &k) in k.iter().enumerate().filter(|(_, k)| **k > 0) {
        result *= of(channel).powi(k);
    }
    let total: i32 = k.iter().sum();
    match total {
        0 => by,
        _ if result == 0.0 => 0.0,
        _ => result / by.powi(total - 1),
    }
}

//! What a path that was found scores in each channel, by the balance heuristic over all heroes.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h (p_uni,h + p_nee,h),   f_λ = p_uni,λ = q_λ ρ_λ,  p_nee,λ = q_λ,  ρ_λ = p_λ(ω) Π (1 − r_λ)
//! ```
//!
//! q is what both techniques have in common: the path up to the last real scattering, the transmittances through
//! σ̂ and the rates of tentative collisions; ρ what hits must win by chance on the last segment, the direction and its
//! null collisions. A hit scores what a shadow ray along the same path scores. Where the path was never scattered, and
//! where no shadow rays are cast, `p_nee = 0`.
//!
//! Densities are kept relative to those of the walking hero, what depends on the length ℓ and the number n of
//! tentative collisions as a logarithm:
//!
//! ```text
//! ln(q_λ/q_h) = ln(weight_λ) + n ln(σ̂_λ/σ̂_h) − (σ̂_λ − σ̂_h) ℓ
//! ```

use crate::setup::Setup;
use crate::setup::heroes::Heroes;
use media::body::MOST_CHANNELS;
use numeric::Lane;

pub use crate::walks::hero::{LastPiece, Weighing};

/// A path that grows, as the densities of all channels see it.
#[derive(Debug, Clone, Copy)]
pub struct Path {
    /// Whose walk it is.
    pub hero: usize,
    /// How long it is.
    pub length: f64,
    /// Its last piece.
    pub last: f64,
    /// Its tentative collisions.
    pub collisions: u32,
    /// What the real scatterings make of q, relative to the hero's.
    pub weights: [f64; MOST_CHANNELS],
    /// `p_λ(ω)` on the last segment.
    pub phases: [f64; MOST_CHANNELS],
    /// `Π (1 − r_λ)` over the null collisions of the last segment.
    pub nulls: [f64; MOST_CHANNELS],
    /// What f has more than the densities, where a bug makes it so.
    pub excess: [f64; MOST_CHANNELS],
}

impl Path {
    /// At the camera.
    #[inline(always)]
    pub fn begin(hero: usize) -> Self {
        let ones = [1.0; MOST_CHANNELS];
        let (length, last, collisions) = (0.0, 0.0, 0);
        Self {
            hero,
            length,
            last,
            collisions,
            weights: ones,
            phases: ones,
            nulls: ones,
            excess: ones,
        }
    }

    /// Goes on through a piece of a length.
    #[inline(always)]
    pub fn go_on(&mut self, piece: f64) {
        self.length += piece;
        self.last = piece;
    }

    /// Multiplies the densities of so many channels at a collision; they stay relative to the hero's, or to the density
    /// of what happened where all channels walk together.
    #[inline(always)]
    pub fn collide(&mut self, count: usize, of_all: Option<f64>, factor: impl Fn(usize) -> f64) {
        self.collisions += 1;
        for (channel, weight) in self.weights[..count].iter_mut().enumerate() {
            *weight *= factor(channel);
        }
        // Only a bug can make the hero's 0.
        let scale = of_all.unwrap_or(self.weights[self.hero]);
        if scale > 0.0 {
            for weight in &mut self.weights[..count] {
                *weight /= scale;
            }
        }
    }

    /// `q_λ/q_h` of a path of a length.
    #[inline(always)]
    pub fn common<P>(&self, setup: &Setup<P>, channel: usize, length: f64) -> f64 {
        let (own, hero) = (&setup.channels[channel], &setup.channels[self.hero]);
        let log = f64::from(self.collisions) * (own.ln_majorant - hero.ln_majorant);
        self.weights[channel] * Lane::exp(log - (own.majorant - hero.majorant) * length)
    }

    /// What it scores without multiple importance sampling, where there is no next-event estimation: the densities of
    /// all channels relative to the walker's.
    #[inline(always)]
    pub fn relative<P>(&self, setup: &Setup<P>) -> [f64; MOST_CHANNELS] {
        let mut found = [0.0; MOST_CHANNELS];
        for (channel, found) in found[..setup.channels.len()].iter_mut().enumerate() {
            *found = self.common(setup, channel, self.length);
        }
        found
    }

    /// What it scores by the balance heuristic.
    #[inline(always)]
    pub fn score<P>(
        &self,
        setup: &Setup<P>,
        heroes: &Heroes,
        by: Weighing,
    ) -> [f64; MOST_CHANNELS] {
        let count = setup.channels.len();
        let has_last = by.last_piece == LastPiece::Everywhere;
        let length = if has_last { self.length } else { self.length - self.last };
        let (mut found, mut density) = ([0.0; MOST_CHANNELS], 0.0);
        for (channel, own) in setup.channels.iter().enumerate() {
            let common = self.common(setup, channel, length);
            let direction = common * self.phases[channel];
            let by_hit = direction * self.nulls[channel];
            found[channel] = by_hit * self.excess[channel];
            if by.last_piece == LastPiece::InContribution {
                found[channel] *= Lane::exp(-own.majorant * self.last);
            }
            if channel + by.missing < count {
                let chance = heroes.probability(count, channel);
                density += chance * if by.has_nulls { by_hit } else { direction };
                density += if by.has_next_event { chance * common } else { 0.0 };
            }
        }
        let scale = if density > 0.0 { 1.0 / (density * by.share) } else { 0.0 };
        for found in &mut found[..count] {
            *found *= scale;
        }
        found
    }
}

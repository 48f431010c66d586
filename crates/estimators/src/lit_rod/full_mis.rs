//! Hits and shadow rays, weighted by the pdfs of the whole null-scattering path.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! ρ = p_uni/p_nee = p(ω) Π (1 − r)   over the null collisions of the last segment, r = σ_t/σ̂
//! X = [reached unscattered] + Σ p t̂ w_nee(ρ) + [hit after y] w_uni(ρ),   t̂ = Π (1 − r) by ratio tracking
//! balance: both score ρ/(1 + ρ);   power: a hit scores ρ²/(1 + ρ²), a shadow ray ρ/(1 + ρ²)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"ratio"` tracking through σ̂; `"exact"`: transmittances instead of null collisions in both densities, `ρ = p(ω) T(y, L)` | `"ratio"` |
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |
//!
//! Majorant transmittances and probabilities of events that both densities contain cancel in ρ. The factors that
//! remain are the probabilities 1 − r of null collisions: unidirectional tracking samples these events, ratio
//! tracking does not. ρ is reset at every real scattering. In the unscattered segment `p_nee = 0`: it scores 1.
//!
//! It takes σ̂, which must be a majorant. As printed, Algorithm 2 of the source averages over both samples, which is
//! right only where one of them is chosen, and Algorithm 1 does not divide hits by `p_uni + p_nee`: both are
//! among the known bugs of `trueflight-lab self-test`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), section 5.3, Algorithms 1 and 2, Eq. 42.
//!
//! ```toml
//! title = "An example of full-mis"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.9
//! forward = 0.75
//! light = "emitter"
//! sampling = 1.6
//! estimators = ["full-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Lit, lit, read_shadow};
use crate::Estimator;
use crate::setup::heuristic;
use media::catalogue::Settings;
use theory::light::{Combination, Densities, Heuristic, Shadow, Techniques};

/// Multiple importance sampling over null-scattering paths; σ̂ is its input.
#[derive(Debug, Clone)]
pub struct FullMis {
    shadow: Shadow,
    heuristic: Heuristic,
}

impl FullMis {
    fn techniques(&self) -> Techniques {
        let combination = Combination::Mis(Densities::Full, self.heuristic);
        Techniques { shadow: Some(self.shadow), combination }
    }
}

impl<P: Lit> Estimator<P> for FullMis {
    fn read(settings: &Settings) -> Option<Self> {
        let shadow = read_shadow(settings, &["ratio", "exact"], "ratio");
        let heuristic = heuristic::read(settings);
        Some(Self { shadow: shadow?, heuristic: heuristic? })
    }

    lit!(self => self.techniques());
}

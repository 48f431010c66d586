//! Hits and shadow rays, weighted by the pdfs of directions: what most renderers do.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! ρ = p_uni/p_nee = p(ω)/1,   null collisions are left out of both densities
//! X = [reached unscattered] + Σ p t̂(y, L) w_nee(ρ) + [hit after y] w_uni(ρ)
//! balance: w_uni = ρ/(1 + ρ);  power: w_uni = ρ²/(1 + ρ²);  w_nee = 1 − w_uni
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | t̂: `"exact"` transmittance, `"delta"` or `"ratio"` tracking through σ̂ | `"delta"` |
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |
//!
//! Unbiased, as the weights of both techniques sum to 1 for every direction. With delta-tracked shadow rays null
//! collisions have the same probabilities in both techniques, and cancel. With ratio tracking they do not cancel,
//! and a hit through many of them has too large a weight.
//!
//! It takes σ̂, which must be a majorant.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering Heterogeneous
//! Volumes*, ACM Transactions on Graphics 36 (2017); B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path
//! integral formulation of light transport*, ACM Transactions on Graphics 38 (2019), section 6; the power
//! heuristic: E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, doctoral thesis, Stanford (1997).
//!
//! ```toml
//! title = "An example of directional-mis"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.9
//! forward = 0.75
//! light = "emitter"
//! sampling = 1.6
//! estimators = ["directional-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Lit, lit, read_shadow};
use crate::Estimator;
use crate::setup::heuristic;
use media::catalogue::Settings;
use theory::light::{Combination, Densities, Heuristic, Shadow, Techniques};

/// Multiple importance sampling over directions; σ̂ is its input.
#[derive(Debug, Clone)]
pub struct DirectionalMis {
    shadow: Shadow,
    heuristic: Heuristic,
}

impl DirectionalMis {
    fn techniques(&self) -> Techniques {
        let combination = Combination::Mis(Densities::Directional, self.heuristic);
        Techniques { shadow: Some(self.shadow), combination }
    }
}

impl<P: Lit> Estimator<P> for DirectionalMis {
    fn read(settings: &Settings) -> Option<Self> {
        let shadow = read_shadow(settings, &["exact", "delta", "ratio"], "delta");
        let heuristic = heuristic::read(settings);
        Some(Self { shadow: shadow?, heuristic: heuristic? })
    }

    lit!(self => self.techniques());
}

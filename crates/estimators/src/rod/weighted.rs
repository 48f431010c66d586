//! Delta tracking with the albedo as a weight, for any σ̂.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0; refused where the variance is infinite.
//!
//! ```text
//! D = |r| + |1 − r|,  r = σ_t/σ̂
//! scattered with probability |r|/D and weight a sgn(r) D w, straight on with |1 − r|/D and sgn(1 − r) D w
//! ```
//!
//! It takes σ̂ and no settings. Where `σ̂ ≥ σ_t` a collision is real with probability r, and then the weight is
//! multiplied by a: absorption is by weight alone. Elsewhere probabilities and weights are those of weighted delta
//! tracking (the non-terminating rule of a = 1). At a = 0 a real collision ends the walk: its weight is 0. Beyond
//! the critical length of its second moment it is refused.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.2 (albedo as weight); the probabilities below σ_t: M. Galtier et
//! al., *Integral formulation of null-collision Monte Carlo algorithms*, Journal of Quantitative Spectroscopy and
//! Radiative Transfer 125 (2013).
//!
//! ```toml
//! title = "An example of weighted"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! forward = 0.6
//! sampling = 1.6
//! estimators = ["weighted"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::by_rule;

/// Weighted delta tracking; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Weighted;

by_rule!(Weighted);

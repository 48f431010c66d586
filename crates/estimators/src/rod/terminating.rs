//! The single particle model with weights ±1: a walk ends where it cannot keep its weight.
//!
//! Unbiased for: r ≤ 2/(a + 1); refused elsewhere.
//!
//! ```text
//! scattered with probability a r and weight w, straight on with probability |1 − r| and weight sgn(1 − r) w,
//! absorbed otherwise;  r = σ_t/σ̂
//! ```
//!
//! It takes σ̂ and no settings. It exists for `0 ≤ r ≤ 2/(a + 1)`, where the probabilities add up to at most 1, and
//! is refused elsewhere. Draws lie in {−1, 0, 1}, the negative ones only where σ̂ < σ_t, and `E[X²] ≥ E[X]`. Where
//! σ̂ ≥ σ_t its draws have the same distribution as those of `analog`.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! sections 3.1 and 3.2, Eq. 9, and `SimulateParticle`.
//!
//! ```toml
//! title = "An example of terminating"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! forward = 0.6
//! sampling = 1.6
//! estimators = ["terminating"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::by_rule;

/// The terminating rule; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Terminating;

by_rule!(Terminating);

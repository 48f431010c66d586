//! The single particle model that never ends inside the medium: absorption reduces the weight.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0; refused where the variance is infinite.
//!
//! ```text
//! D = a|r| + |1 − r|,  r = σ_t/σ̂
//! scattered with probability a|r|/D and weight sgn(r) D w, straight on with |1 − r|/D and sgn(1 − r) D w
//! ```
//!
//! It takes σ̂ and no settings, and exists for every σ̂ that is positive where σ_t is. Where `σ̂ ≥ σ_t`
//! the weight `D = 1 − (1 − a) r` never exceeds 1. Far below, D grows with every collision, and beyond
//! the critical length of its second moment the variance is infinite: then it is refused.
//!
//! The number of lookups, averaged over particles that enter at either end, is ∫σ̂ in any medium.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! sections 3.2 and 3.3, Eq. 12.
//!
//! ```toml
//! title = "An example of non-terminating"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! forward = 0.6
//! sampling = 1.6
//! estimators = ["non-terminating"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::by_rule;

/// The non-terminating rule; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct NonTerminating;

by_rule!(NonTerminating);

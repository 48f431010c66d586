//! The single particle model as `SimulateParticle` has it: terminating for minorants where that is
//! possible, else non-terminating.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0; refused where the variance is infinite.
//!
//! ```text
//! terminating where r ≥ 1 and a r + |1 − r| ≤ 1, that is 1 ≤ r ≤ 2/(a + 1);  else non-terminating
//! ```
//!
//! It takes σ̂ and no settings, and exists for every σ̂ that is positive where σ_t is.
//!
//! According to the paper it is never worse than either rule alone. Its variance is never below that of the
//! non-terminating rule: where it terminates, its second moments `S₂ = a r` and `Q₂ = |1 − r|` are those of the
//! other over `D ≤ 1`. It saves lookups, only where σ̂ is below σ_t, and none at a = 1.
//! `trueflight run rod/three-rules-a0.7` shows variance, lookups and figure of merit of the three.
//!
//! The pseudo-code has `a r` where a negative r would need `a|r|`; this page has `a|r|`.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.1, `SimulateParticle`.
//!
//! ```toml
//! title = "An example of adaptive"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! forward = 0.6
//! sampling = 1.6
//! estimators = ["adaptive"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::by_rule;

/// The adaptive rule; σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct Adaptive;

by_rule!(Adaptive);

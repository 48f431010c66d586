//! The single particle model as `SimulateParticle` has it, in a slab: terminating for minorants where
//! that is possible, else non-terminating.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0; refused where the variance is infinite.
//!
//! ```text
//! terminating where r ≥ 1 and a r + |1 − r| ≤ 1, that is 1 ≤ r ≤ 2/(a + 1);  else non-terminating
//! ```
//!
//! It takes σ̂ and no settings, and exists where its variance is finite, see `non-terminating`. As in the rod, its
//! variance is never below that of the non-terminating rule; it saves lookups.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.1, `SimulateParticle`.
//!
//! ```toml
//! title = "An example of adaptive"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.6
//! sampling = 1.6
//! estimators = ["adaptive"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::rod::adaptive::Adaptive;

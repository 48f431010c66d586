//! The single particle model that never ends inside a slab: absorption reduces the weight.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0; refused where the variance is infinite.
//!
//! ```text
//! D = a|r| + |1 − r|,  r = σ_t/σ̂
//! scattered with probability a|r|/D and weight sgn(r) D w, straight on with |1 − r|/D and sgn(1 − r) D w
//! ```
//!
//! It takes σ̂ and no settings, and exists for every σ̂ that is positive where σ_t is. Where `σ̂ ≥ σ_t` the weight
//! `D = 1 − (1 − a) r` never exceeds 1. Below σ_t, it grows at every collision, and light along the layers collides
//! without end. Where `(r − 1) D ≥ 1`, or where the slab is too thick for the moment of scattered weights, the
//! variance is infinite, and the walk is refused.
//!
//! Under equal diffuse light from above and from below, the mean number of lookups is `2∫σ̂ dz` in any medium: the
//! mean chord of the slab times the mean σ̂.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! sections 3.2 and 3.3, Eq. 12.
//!
//! ```toml
//! title = "An example of non-terminating"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.6
//! sampling = 1.6
//! estimators = ["non-terminating"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::rod::non_terminating::NonTerminating;

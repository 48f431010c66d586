//! A hit and a shadow ray, weighted by the pdfs of the whole null-scattering path.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere, and for τ/μ > 64.
//!
//! ```text
//! ρ = p_uni/p_nee = q Π (1 − r)   over the null collisions of the last segment, q = p(μ)/p_nee, r = σ_t/σ̂
//! X = q t̂ w_nee(ρ) + [hit] w_uni(ρ),   t̂ = Π (1 − r) by ratio tracking, each with its own direction
//! balance: both score ρ/(1 + ρ);   power: a hit scores ρ²/(1 + ρ²), a shadow ray ρ/(1 + ρ²)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"ratio"` tracking through σ̂; `"exact"`: transmittances instead of null collisions in both densities, `ρ = q T` | `"ratio"` |
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |
//!
//! Common factors of both densities cancel in ρ. A light without a size has `p_uni = 0` and `w_nee = 1`: next-event
//! estimation. It takes σ̂, which must be a majorant.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), section 5.3, Algorithms 1 and 2, Eq. 42.
//!
//! ```toml
//! title = "An example of full-mis"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 1.5]
//! albedo = 0.9
//! phase.henyey-greenstein.g = 0.85
//! light.cap.cosine = 0.9
//! sampling = 1.6
//! estimators = ["full-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::lit_rod::full_mis::FullMis;

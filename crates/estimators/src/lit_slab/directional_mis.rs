//! A hit and a shadow ray, weighted by the pdfs of directions: what most renderers do.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere, and for τ/μ > 64.
//!
//! ```text
//! ρ = q = p(μ)/p_nee,   null collisions are left out of both densities
//! X = q t̂ w_nee(ρ) + [hit] w_uni(ρ),   each with its own direction
//! balance: w_uni = ρ/(1 + ρ);  power: w_uni = ρ²/(1 + ρ²);  w_nee = 1 − w_uni
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | t̂: `"exact"` transmittance, `"delta"` or `"ratio"` tracking through σ̂ | `"delta"` |
//! | `heuristic` | `"balance"` or `"power"` | `"balance"` |
//!
//! Unbiased, as the weights of both techniques sum to 1 for every direction. A light without a size has `w_nee = 1`:
//! next-event estimation. It takes σ̂, which must be a majorant.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering Heterogeneous
//! Volumes*, ACM Transactions on Graphics 36 (2017); B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path
//! integral formulation of light transport*, ACM Transactions on Graphics 38 (2019), section 6; the power
//! heuristic: E. Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, doctoral thesis, Stanford (1997).
//!
//! ```toml
//! title = "An example of directional-mis"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 1.5]
//! albedo = 0.9
//! phase.henyey-greenstein.g = 0.85
//! light.cap.cosine = 0.9
//! sampling = 1.6
//! estimators = ["directional-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::lit_rod::directional_mis::DirectionalMis;

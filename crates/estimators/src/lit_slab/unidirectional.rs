//! Unidirectional path tracing: delta tracking, a direction by the phase function, and again until it hits the light.
//!
//! Unbiased for: σ̂ ≥ σ_t and a light with a size; refused elsewhere, and for τ/μ > 64.
//!
//! ```text
//! X = 1 if the path hits the light after one scattering, else 0;   Var[X] = L(1 − L) whatever σ̂
//! ```
//!
//! It takes σ̂ and no settings. Its distribution is exact. No direction hits a light without a size. A direction
//! that misses the light ends the walk.
//!
//! Source: E. R. Woodcock, T. Murphy, P. J. Hemmings, T. C. Longworth, *Techniques used in the GEM code for Monte
//! Carlo neutronics calculations in reactors and other systems of complex geometry*, ANL-7050 (1965); B. Miller, I.
//! Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM Transactions on Graphics
//! 38 (2019), section 5.2.
//!
//! ```toml
//! title = "An example of unidirectional"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 1.5]
//! albedo = 0.9
//! phase.henyey-greenstein.g = 0.85
//! light.cap.cosine = 0.9
//! sampling = 1.6
//! estimators = ["unidirectional"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::lit_rod::unidirectional::Unidirectional;

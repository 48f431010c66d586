//! Spectral multiple importance sampling: the analog walk of a hero, weighted by the balance heuristic.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! X_λ = a_λ^r/Σ_h w_h a_h^r where it leaves after r scatterings,  the walk with the albedo of the hero
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! No draw exceeds `1/w_λ`: the variance is finite however thick the slab is. It is known for isotropic scattering, and
//! bounded by `E[X²] ≤ E[X]/w_λ` for other phase functions.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.
//!
//! ```toml
//! title = "An example of spectral-mis"
//!
//! [problem.slab]
//! medium = 0.8
//! span = [0, 2]
//! albedos = [0.6, 0.58, 0.56]
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.5
//! sampling = 0.8
//! estimators = ["spectral-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::spectral_rod::spectral_mis::SpectralMis;

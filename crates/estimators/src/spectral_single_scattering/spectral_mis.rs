//! Spectral multiple importance sampling: the first scattering of a hero's walk and a shadow ray from there, weighted by
//! the densities of all heroes.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_λ = q_λ/Σ_h w_h q_h · p_λ(cos θ) Φ/(4π r²) T̂_λ,   q_λ the density of the walk, and of a shadow ray that is tracked
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the hero's σ̂ | `"exact"` |
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, on shadow rays too where they are tracked | required here or in the case |
//!
//! The first factor never exceeds `1/w_λ`. Means and lookups are known; the variance is at most that of `independent`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), sections 5.3 and 5.4.
//!
//! ```toml
//! title = "An example of spectral-mis"
//!
//! [problem.single-scattering]
//! volume = [0.9, 0.8, 0.7]
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }
//! light.position = [0.5, 0, 2]
//! albedos = [0.9, 0.8, 0.7]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! sampling = 1.2
//! estimators = ["spectral-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::MIS;

/// The balance heuristic over heroes.
pub type SpectralMis = OfKind<MIS>;

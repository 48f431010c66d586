//! Spectral multiple importance sampling: a hero's walk, weighted by the densities of all heroes.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h,   f_λ the density of the walk in the channel λ: distances, events, directions
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! `Σ_λ w_λ X_λ = 1` holds for every single draw and is checked. No draw exceeds `1/w_λ`, so that the variance of a
//! channel is at most `1/w_λ − 1`; the variance itself is not known.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 5.1, Algorithm 1.
//!
//! ```toml
//! title = "An example of spectral-mis"
//!
//! [problem.furnace]
//! volume = [
//!   { constant = { extinction = 1.1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } },
//!   { constant = { extinction = 1.0, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } },
//!   { constant = { extinction = 0.9, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } },
//! ]
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedos = [0.7, 0.75, 0.8]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! sampling = 1.6
//! estimators = ["spectral-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::chromatic::page::OfKind;
use crate::setup::walker::MIS;

/// The balance heuristic over heroes.
pub type SpectralMis = OfKind<MIS>;

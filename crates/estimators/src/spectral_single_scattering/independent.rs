//! Independent tracking: one channel a draw, by analog delta tracking through its own medium.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_h = p_h(cos θ) Φ/(4π r²) T̂_h/w_h where the walk scatters, the others 0,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the same σ̂ | `"exact"` |
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, on shadow rays too where they are tracked | required here or in the case |
//!
//! All moments are known: `E[X_λ^k] = w_λ^{1−k} E[x_λ^k]`, x a draw of `delta-tracking` in that channel.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 6.
//!
//! ```toml
//! title = "An example of independent"
//!
//! [problem.single-scattering]
//! volume = [0.9, 0.8, 0.7]
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }
//! light.position = [0.5, 0, 2]
//! albedos = [0.9, 0.8, 0.7]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! sampling = 1.2
//! estimators = ["independent"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::INDEPENDENT;

/// One channel a draw.
pub type Independent = OfKind<INDEPENDENT>;

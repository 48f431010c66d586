//! The walk of one hero to its scattering scores all channels, divided by the hero's density alone.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel, > σ_t where another channel has null collisions; refused
//! elsewhere.
//!
//! ```text
//! X_λ = q_λ/q_h p_λ(cos θ) Φ/(4π r²) T̂_λ,  h of probability w_h,  q as in the walk
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the hero's σ̂ | `"exact"` |
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > σ_t in each channel, on shadow rays too where they are tracked | required here or in the case |
//!
//! All moments are known. The variance is infinite where the hero's σ̂ touches its σ_t and another channel's does
//! not. It is also infinite where the hero's σ_t comes down to 0 and another's does not. On an interval of that
//! kind the draws are biased. Both are refused. Multiple importance sampling solves this: see `spectral-mis`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 5.1; the moments are derived: see the theory of single scattering in
//! several channels.
//!
//! ```toml
//! title = "An example of hero"
//!
//! [problem.single-scattering]
//! volume = [0.9, 0.8, 0.7]
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }
//! light.position = [0.5, 0, 2]
//! albedos = [0.9, 0.8, 0.7]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! sampling = 1.2
//! estimators = ["hero"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::HERO;

/// A single hero, without multiple importance sampling.
pub type Hero = OfKind<HERO>;

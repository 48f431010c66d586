//! Spectral multiple importance sampling: a hero's walk until it hits the emitter, weighted over all heroes.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_λ = p_λ/Σ_h w_h p_h,   p_λ the density of the whole path by the walk of λ: distances, events, directions
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! Algorithm 1 of the source with its exit: a flight beyond the end multiplies f and p by the transmittance through
//! σ̂, and scores. f and p have the phase function of each channel at every scattering, which the source leaves
//! out. Paths that are absorbed or leave at the beginning find no light: their f does not matter.
//!
//! No draw exceeds `1/w_λ`, and with equal probabilities the mean of all channels is 1 or 0. The variance is known where
//! all channels have the same σ_t and σ̂; elsewhere it is bounded, as draws never exceed `1/w`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), sections 5.3 and 5.4, Algorithm 1.
//!
//! ```toml
//! title = "An example of spectral-mis"
//!
//! [problem.rod]
//! medium = [1.1, 1, 0.9]
//! span = [0, 2]
//! albedos = [0.8, 0.75, 0.7]
//! forward = [0.75, 0.75, 0.75]
//! light = "emitter"
//! sampling = 1.6
//! estimators = ["spectral-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::HeroMis;

/// The balance heuristic over heroes.
pub type SpectralMis = HeroMis<false>;

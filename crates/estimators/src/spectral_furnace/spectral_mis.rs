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

use crate::chromatic::page::OfKind;
use crate::setup::walker::MIS;

/// The balance heuristic over heroes.
pub type SpectralMis = OfKind<MIS>;

//! Spectral multiple importance sampling: a hero's walk, weighted by the densities of all heroes.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h f_h where it leaves,   f_λ the density of the walk in the channel λ: lengths, events, directions
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! `Σ_λ w_λ X_λ = 1` holds for every walk that leaves and is checked. No draw exceeds `1/w_λ`, so that
//! `E[X²] ≤ E[X]/w_λ`; the variance itself is not known.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 5.1, Algorithm 1.
//!
//! ```toml
//! title = "An example of spectral-mis"
//!
//! [problem.slab]
//! medium = [1.1, 1, 0.9]
//! span = [0, 1]
//! albedos = [0.7, 0.75, 0.8]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! incidence.collimated.cosine = 0.8
//! sampling = 1.6
//! estimators = ["spectral-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::chromatic::page::OfKind;
use crate::setup::walker::MIS;

/// The balance heuristic over heroes.
pub type SpectralMis = OfKind<MIS>;

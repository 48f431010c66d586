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
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! No draw exceeds `1/w_λ`: the variance is finite however long the rod is. With equal probabilities it is that of
//! history-aware spectral tracking.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.
//!
//! ```toml
//! title = "An example of spectral-mis"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedos = [0.8, 0.7, 0.6]
//! forward = 0.75
//! sampling = 1.2
//! estimators = ["spectral-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::MIS;

/// The balance heuristic over heroes.
pub type SpectralMis = OfKind<MIS>;

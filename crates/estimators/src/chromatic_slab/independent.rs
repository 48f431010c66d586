//! Independent tracking: one channel a draw, by an analog walk through its own medium.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_h = 1/w_h where the walk leaves, the others 0,  h of probability w_h;   E[X_λ^k] = w_λ^{1−k} R_λ, or T_λ
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! All moments are known.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 6.
//!
//! ```toml
//! title = "An example of independent"
//!
//! [problem.slab]
//! medium = [1.1, 1, 0.9]
//! span = [0, 1]
//! albedos = [0.7, 0.75, 0.8]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! incidence.collimated.cosine = 0.8
//! sampling = 1.6
//! estimators = ["independent"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::chromatic::page::OfKind;
use crate::setup::walker::INDEPENDENT;

/// One channel a draw.
pub type Independent = OfKind<INDEPENDENT>;

//! Independent tracking: one channel a draw, by an analog walk through its own medium.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_h = 1/w_h, the others 0,  h of probability w_h;   Var X_λ = 1/w_λ − 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! Every walk scores, whatever its end. In a furnace the variance is therefore only the colour noise without
//! multiple importance sampling.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*,
//! ACM Transactions on Graphics 38 (2019), section 6.
//!
//! ```toml
//! title = "An example of independent"
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
//! estimators = ["independent"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::chromatic::page::OfKind;
use crate::setup::walker::INDEPENDENT;

/// One channel a draw.
pub type Independent = OfKind<INDEPENDENT>;

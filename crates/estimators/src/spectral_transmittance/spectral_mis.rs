//! Spectral multiple importance sampling: the walk of one hero, weighted by the balance heuristic over all.
//!
//! Unbiased for: a constant σ̂ > 0 in each channel, ≥ σ_t with `collisions = "delta"`; refused elsewhere.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h p_h,  f and p of the whole null-collision path, as in the walk
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `collisions` | `"ratio"` or `"delta"` | `"ratio"` |
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel, the same in all or not; at least σ_t for `"delta"` | required here or in the case |
//!
//! Unbiased there. With delta tracking no draw exceeds `1/w_λ`, and with equal probabilities the mean of all
//! channels is 1 or 0: only the colour noise is reduced. With ratio tracking the density of a path depends on the
//! number of its collisions only. The variance of delta tracking is known in media that are constant in each cell;
//! elsewhere it is bounded, as draws never exceed `1/w`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.
//!
//! ```toml
//! title = "An example of spectral-mis"
//!
//! [problem.transmittance]
//! medium = [
//!   { exponential = { extinction = 1.2, rate = 0.5 } },
//!   { exponential = { extinction = 1.0, rate = 0.5 } },
//!   { exponential = { extinction = 0.8, rate = 0.5 } },
//! ]
//! span = [0, 3]
//! sampling = 1.5
//! estimators = [{ spectral-mis.collisions = "delta" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::MIS;

/// The balance heuristic over heroes.
pub type SpectralMis = OfKind<MIS>;

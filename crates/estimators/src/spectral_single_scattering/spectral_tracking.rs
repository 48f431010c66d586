//! Spectral tracking: all channels walk together through one σ̂, with event probabilities that depend on all of
//! them.
//!
//! Unbiased for: one constant σ̂ ≥ σ_t for all channels; refused elsewhere.
//!
//! ```text
//! at a collision an event e has the probability P_e, then w_λ ← w_λ μ_e,λ/(μ̄ P_e);   where it scatters
//! X_λ = w_λ p_λ(cos θ) Φ/(4π r²) T̂_λ
//! average  P_e = mean_λ μ_e,λ/μ̄      maximum  P_e ∝ max_λ μ_e,λ      history  P_e ∝ Σ_λ w_λ μ_e,λ
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"`, `"maximum"` or `"history"` | `"average"` |
//! | `shadow` | `"exact"`, or `"ratio"`: ratio tracking through the same σ̂ | `"exact"` |
//! | `sampling` | one constant σ̂ for all channels, at least the σ_t of each, on shadow rays too where they are tracked | required here or in the case |
//!
//! Unbiased there. With fixed probabilities all moments are known. With probabilities that depend on the weights a
//! mean and a bound are known: they score the same as `spectral-mis` with one σ̂ and equal probabilities.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), sections 5.1.1 and 5.1.2.
//!
//! ```toml
//! title = "An example of spectral-tracking"
//!
//! [problem.single-scattering]
//! volume = [0.9, 0.8, 0.7]
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }
//! light.position = [0.5, 0, 2]
//! albedos = [0.9, 0.8, 0.7]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! sampling = 1.2
//! estimators = ["spectral-tracking"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::SPECTRAL_TRACKING;

/// Spectral tracking.
pub type SpectralTracking = OfKind<SPECTRAL_TRACKING>;

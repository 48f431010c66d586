//! Spectral tracking: all channels walk together through one σ̂, with event probabilities that depend on all of
//! them.
//!
//! Unbiased for: one constant σ̂ ≥ σ_t and one phase function for all channels, `average` and `maximum` as long as
//! theory bounds the variance; refused elsewhere.
//!
//! ```text
//! at a collision an event e has the probability P_e, then w_λ ← w_λ μ_e,λ/(μ̄ P_e);   X_λ = w_λ wherever it ends
//! average  P_e = mean_λ μ_e,λ/μ̄      maximum  P_e ∝ max_λ μ_e,λ      history  P_e ∝ Σ_λ w_λ μ_e,λ
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"`, `"maximum"` or `"history"` | `"average"` |
//! | `sampling` | one constant σ̂ for all channels, at least the σ_t of each | required here or in the case |
//!
//! Unbiased there, with one phase function for all channels. The variance is not known. Fixed probabilities have a
//! bound where σ_t has one value in each channel and `E[X²]` is multiplied by less than 1 from one scattering to
//! the next. Elsewhere it may be infinite, and the estimator is refused. Probabilities that depend on the weights
//! score the same as `spectral-mis` with one σ̂ and equal probabilities, and are bounded everywhere.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), sections 5.1.1 and 5.1.2.
//!
//! ```toml
//! title = "An example of spectral-tracking"
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
//! estimators = ["spectral-tracking"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::chromatic::page::OfKind;
use crate::setup::walker::SPECTRAL_TRACKING;

/// Spectral tracking.
pub type SpectralTracking = OfKind<SPECTRAL_TRACKING>;

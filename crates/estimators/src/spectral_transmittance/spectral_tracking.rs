//! Spectral tracking: one σ̂ for all channels, and a probability of null collisions that depends on all of them.
//!
//! Unbiased for: one constant σ̂ ≥ σ_t for all channels; refused elsewhere.
//!
//! ```text
//! at a collision null with P_n, then w_λ ← w_λ (n_λ/μ̄)/P_n;  else real, and X = 0;   X_λ = w_λ at the end
//! average  P_n = mean_λ n_λ/μ̄
//! maximum  P_n = max n/(max n + max σ)
//! history  P_n = Σ |w_λ n_λ| / (Σ |w_λ n_λ| + Σ |w_λ σ_λ|)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"`, `"maximum"` or `"history"` | `"average"` |
//! | `sampling` | one constant σ̂ for all channels, at least the σ_t of each | required here or in the case |
//!
//! Unbiased there. The history-aware form scores the same as `spectral-mis` with delta tracking, one σ̂ and equal
//! probabilities.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), sections 5.1.1 and 5.1.2.
//!
//! ```toml
//! title = "An example of spectral-tracking"
//!
//! [problem.transmittance]
//! medium = [
//!   { exponential = { extinction = 1.2, rate = 0.5 } },
//!   { exponential = { extinction = 1.0, rate = 0.5 } },
//!   { exponential = { extinction = 0.8, rate = 0.5 } },
//! ]
//! span = [0, 3]
//! sampling = 1.5
//! estimators = [{ spectral-tracking.probabilities = "average" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::SPECTRAL_TRACKING;

/// Spectral tracking.
pub type SpectralTracking = OfKind<SPECTRAL_TRACKING>;

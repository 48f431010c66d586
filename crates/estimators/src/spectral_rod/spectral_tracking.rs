//! Spectral tracking in a rod: one scattering probability for all channels.
//!
//! Unbiased for: σ̂ ≥ σ_t, as long as the variance is finite; refused elsewhere.
//!
//! ```text
//! a real collision scatters with P_s, then w_λ ← w_λ a_λ/P_s;  X_λ = w_λ where it leaves
//! average  P_s = mean a        maximum  P_s = a_max/(a_max + (1 − a)_max)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"` or `"maximum"` | `"average"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Null collisions are the same in all channels and are decided first. Unbiased everywhere, but the variance of a
//! channel is infinite where `a_λ²/P_s` is the albedo of a rod beyond its critical length: refused from there on. A
//! finite variance may still be out of reach of any number of draws: the fourth moment needs `a_λ⁴/P_s³`.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5.1.
//!
//! ```toml
//! title = "An example of spectral-tracking"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedos = [0.8, 0.7, 0.6]
//! forward = 0.75
//! sampling = 1.2
//! estimators = [{ spectral-tracking.probabilities = "average" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::SPECTRAL_TRACKING;

/// Spectral tracking.
pub type SpectralTracking = OfKind<SPECTRAL_TRACKING>;

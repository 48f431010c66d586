//! Spectral tracking in a slab: one scattering probability for all channels.
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
//! Unbiased everywhere, but the variance of a channel is infinite where `a_λ²/P_s` is at least the albedo at which
//! a slab of this depth is critical: refused there, and within a thousandth of that depth. A finite variance may
//! still be out of reach of any number of draws: the fourth moment needs `a_λ⁴/P_s³`.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), section 5.1; critical slabs: K. M. Case, P. F.
//! Zweifel, *Linear Transport Theory* (1967).
//!
//! ```toml
//! title = "An example of spectral-tracking"
//!
//! [problem.slab]
//! medium = 0.8
//! span = [0, 2]
//! albedos = [0.6, 0.58, 0.56]
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.5
//! sampling = 0.8
//! estimators = [{ spectral-tracking.probabilities = "average" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::spectral_rod::spectral_tracking::SpectralTracking;

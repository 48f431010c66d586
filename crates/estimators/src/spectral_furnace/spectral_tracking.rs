//! Spectral tracking: all channels walk together through one σ̂, by chances that depend on all of them.
//!
//! Unbiased for: one constant σ̂ ≥ σ_t and one phase function for all channels, `average` and `maximum` as long as
//! theory bounds the variance; refused elsewhere.
//!
//! ```text
//! at a collision an event e has the chance P_e, then w_λ ← w_λ μ_e,λ/(μ̄ P_e);   X_λ = w_λ wherever it ends
//! average  P_e = mean_λ μ_e,λ/μ̄      maximum  P_e ∝ max_λ μ_e,λ      history  P_e ∝ Σ_λ w_λ μ_e,λ
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `probabilities` | `"average"`, `"maximum"` or `"history"` | `"average"` |
//! | `sampling` | one constant σ̂ for all channels, at least the σ_t of each | required here or in the case |
//!
//! Unbiased there, with one phase function for all channels. What the variance is theory does not know: of fixed chances it
//! has a bound where σ_t has one value in each channel and `E[X²]` is multiplied by less than 1 from one scattering to the next, and what
//! has none is refused: its variance may be infinite. Chances that depend on the weights score what `spectral-mis` scores
//! with one σ̂ and equal probabilities, and are bounded everywhere.
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering
//! Heterogeneous Volumes*, ACM Transactions on Graphics 36 (2017), sections 5.1.1 and 5.1.2.

use crate::chromatic::all_channels::AllChannels;
use crate::setup::walker::SPECTRAL_TRACKING;

/// Spectral tracking.
pub type SpectralTracking = AllChannels<SPECTRAL_TRACKING>;

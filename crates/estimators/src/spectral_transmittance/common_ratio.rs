//! Ratio tracking of all channels at once, through one σ̂ for all.
//!
//! Unbiased for: every constant σ̂ > 0.
//!
//! ```text
//! X_λ = Π (1 − σ_λ(tᵢ)/μ̄),  tᵢ a Poisson process of rate μ̄
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | one constant σ̂ > 0 for all channels | required here or in the case |
//!
//! Only the places are random: where the densities of the channels are alike it has the least variance of all.
//!
//! Source: J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating Attenuation in Participating
//! Media*, ACM Transactions on Graphics 33 (2014), with one majorant for all channels.
//!
//! ```toml
//! title = "An example of common-ratio"
//!
//! [problem.transmittance]
//! medium = [
//!   { exponential = { extinction = 1.2, rate = 0.5 } },
//!   { exponential = { extinction = 1.0, rate = 0.5 } },
//!   { exponential = { extinction = 0.8, rate = 0.5 } },
//! ]
//! span = [0, 3]
//! sampling = 1.5
//! estimators = ["common-ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::{COMMON_RATIO, OfKind};

/// The ratio tracker of all channels.
pub type CommonRatio = OfKind<COMMON_RATIO>;

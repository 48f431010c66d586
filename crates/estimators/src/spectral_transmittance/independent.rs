//! Independent tracking: each channel by walks of its own, through its own σ̂.
//!
//! Unbiased for: a constant σ̂ > 0 in each channel, ≥ σ_t with `collisions = "delta"`; refused elsewhere.
//!
//! ```text
//! one channel a draw   X_h = x_h/w_h, the others 0,  h of probability w_h
//! all channels in turn X_λ = x_λ, each by a walk of its own
//! x = Π (1 − σ_t/σ̂) (ratio) or 1 where no collision is real (delta)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `collisions` | `"ratio"` or `"delta"` | `"ratio"` |
//! | `channels` | `"one"` a draw, or `"all"` in turn | `"one"` |
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel; at least σ_t for `"delta"` | required here or in the case |
//!
//! Unbiased there. With one channel a draw the colour noise is the largest possible.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 6.
//!
//! ```toml
//! title = "An example of independent"
//!
//! [problem.transmittance]
//! medium = [
//!   { exponential = { extinction = 1.2, rate = 0.5 } },
//!   { exponential = { extinction = 1.0, rate = 0.5 } },
//!   { exponential = { extinction = 0.8, rate = 0.5 } },
//! ]
//! span = [0, 3]
//! sampling = 1.5
//! estimators = [{ independent.collisions = "delta" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::INDEPENDENT;

/// Independent tracking.
pub type Independent = OfKind<INDEPENDENT>;

//! Independent tracking: one channel a draw, by an analog walk with its own albedo.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! X_h = 1/w_h where it leaves, the others 0,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the channel: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 6.

use super::page::OfKind;
use crate::setup::walker::INDEPENDENT;

/// Independent tracking.
pub type Independent = OfKind<INDEPENDENT>;

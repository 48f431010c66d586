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
//!
//! ```toml
//! title = "An example of independent"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedos = [0.8, 0.7, 0.6]
//! forward = 0.75
//! sampling = 1.2
//! estimators = ["independent"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::INDEPENDENT;

/// Independent tracking.
pub type Independent = OfKind<INDEPENDENT>;

//! The walk of one hero channel scores all channels, divided by the hero's density alone.
//!
//! Unbiased for: a constant σ̂ > 0 in each channel; with `collisions = "delta"` σ̂ ≥ σ_t, > σ_t where another
//! channel has null collisions; refused elsewhere.
//!
//! ```text
//! X_λ = f_λ/p_h,  h of probability w_h,  f and p as in the walk
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `collisions` | `"ratio"` or `"delta"` | `"ratio"` |
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > 0 in each channel; at least σ_t for `"delta"` | required here or in the case |
//!
//! With delta tracking the variance is infinite where the hero's σ̂ touches its σ_t and another channel's does not,
//! and the draws are biased where it does so on an interval: both are refused. Multiple importance sampling solves
//! this: see `spectral-mis`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1.
//!
//! ```toml
//! title = "An example of hero"
//!
//! [problem.transmittance]
//! medium = [
//!   { exponential = { extinction = 1.2, rate = 0.5 } },
//!   { exponential = { extinction = 1.0, rate = 0.5 } },
//!   { exponential = { extinction = 0.8, rate = 0.5 } },
//! ]
//! span = [0, 3]
//! sampling = 1.5
//! estimators = [{ hero.collisions = "ratio" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::OfKind;
use crate::setup::walker::HERO;

/// A single hero, without multiple importance sampling.
pub type Hero = OfKind<HERO>;

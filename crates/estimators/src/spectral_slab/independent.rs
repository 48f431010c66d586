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
//! | `hero` | distribution of the channel: `"uniform"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 6.
//!
//! ```toml
//! title = "An example of independent"
//!
//! [problem.slab]
//! medium = 0.8
//! span = [0, 2]
//! albedos = [0.6, 0.58, 0.56]
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.5
//! sampling = 0.8
//! estimators = ["independent"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::spectral_rod::independent::Independent;

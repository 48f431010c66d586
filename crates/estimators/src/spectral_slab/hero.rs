//! The analog walk of one hero scores all channels, divided by the hero's density alone.
//!
//! Unbiased for: σ̂ ≥ σ_t, as long as the variance is finite; refused elsewhere.
//!
//! ```text
//! X_λ = (a_λ/a_h)^r where it leaves after r scatterings,  h of probability w_h
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | σ̂ ≥ σ_t | required here or in the case |
//!
//! Unbiased where the albedos of all heroes are positive, or all are 0. The variance of a channel is infinite where
//! `a_λ²/a_h` is at least the albedo at which a slab of this depth is critical: refused there, and within a
//! thousandth of that depth. A finite variance may still be out of reach of any number of draws: the fourth moment
//! needs `a_λ⁴/a_h³`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1; critical slabs: K. M. Case, P. F. Zweifel, *Linear
//! Transport Theory* (1967).
//!
//! ```toml
//! title = "An example of hero"
//!
//! [problem.slab]
//! medium = 0.8
//! span = [0, 2]
//! albedos = [0.6, 0.58, 0.56]
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.5
//! sampling = 0.8
//! estimators = ["hero"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::spectral_rod::hero::Hero;

//! Next-event estimation: the scattering casts a shadow ray to the light.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere, and for τ/μ > 64.
//!
//! ```text
//! X = q t̂ after a scattering,   q = p(μ)/p_nee of the direction that is chosen, t̂ along it
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | t̂: `"exact"` transmittance, `"delta"` or `"ratio"` tracking through σ̂ | `"ratio"` |
//!
//! It takes σ̂, which must be a majorant. A tentative collision of a shadow ray is a lookup; delta tracking stops at a
//! real one. Exact shadow rays cost none; they are theory, which uses the platform's library: the last bits of
//! their draws may differ between machines. A wide light and a sharp phase function are its worst case: most directions
//! that it chooses are not those in which light is scattered.
//!
//! Source: R. R. Coveyou, V. R. Cain, K. J. Yost, *Adjoint and Importance in Monte Carlo Application*, Nuclear
//! Science and Engineering 27 (1967); J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating
//! Attenuation in Participating Media*, ACM Transactions on Graphics 33 (2014).
//!
//! ```toml
//! title = "An example of next-event"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 1.5]
//! albedo = 0.9
//! phase.henyey-greenstein.g = 0.85
//! light.cap.cosine = 0.9
//! sampling = 1.6
//! estimators = [{ next-event.shadow = "delta" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::lit_rod::next_event::NextEvent;

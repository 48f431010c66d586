//! Analog delta tracking through a slab: a collision is real with probability r, and then absorbs with probability
//! 1 − a.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! scattered with probability a r, straight on with 1 − r, absorbed with (1 − a) r;  w = 1;  r = σ_t/σ̂
//! ```
//!
//! It takes σ̂ and no settings. Its distribution is exact. Draws are 0 or 1, and the
//! variances are `R(1 − R)` and `T(1 − T)` whatever σ_t and σ̂.
//!
//! Source: E. R. Woodcock, T. Murphy, P. Hemmings, T. Longworth, *Techniques used in the GEM code
//! for Monte Carlo neutronics calculations*, ANL-7050 (1965); B. Miller, I. Georgiev, W. Jarosz, *A
//! null-scattering path integral formulation of light transport*, ACM Transactions on Graphics 38
//! (2019), section 5.2.
//!
//! ```toml
//! title = "An example of analog"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.6
//! sampling = 1.6
//! estimators = ["analog"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::rod::analog::Analog;

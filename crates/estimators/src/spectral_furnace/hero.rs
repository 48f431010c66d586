//! The walk of one hero scores all channels, divided by the hero's density alone.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel, > σ_t where another channel has null collisions, and
//! homogeneous channels, as long as theory bounds the variance; refused elsewhere.
//!
//! ```text
//! X_λ = f_λ/f_h wherever it ends,  h of probability w_h,  f as in the walk
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ > σ_t in each channel | required here or in the case |
//!
//! Unbiased where every event that is possible in a channel is also possible for every hero. The variance is not
//! known. It has a bound where σ_t has one value in each channel and `E[X²]` is multiplied by less than 1 from one
//! scattering to the next. Elsewhere it may be infinite, and the estimator is refused: multiple importance sampling
//! solves this, see `spectral-mis`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1; the bound is derived: see the theory of walks that are
//! relative to the density of one walker.
//!
//! ```toml
//! title = "An example of hero"
//!
//! [problem.furnace]
//! volume = [
//!   { constant = { extinction = 1.1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } },
//!   { constant = { extinction = 1.0, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } },
//!   { constant = { extinction = 0.9, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } },
//! ]
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedos = [0.7, 0.75, 0.8]
//! phases = ["isotropic", "isotropic", "isotropic"]
//! sampling = 1.6
//! estimators = ["hero"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::chromatic::page::OfKind;
use crate::setup::walker::HERO;

/// A single hero, without multiple importance sampling.
pub type Hero = OfKind<HERO>;

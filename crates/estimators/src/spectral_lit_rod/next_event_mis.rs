//! Spectral and next-event multiple importance sampling: hits and shadow rays of one hero, weighted over all heroes.
//!
//! Unbiased for: a constant σ̂ ≥ σ_t in each channel; refused elsewhere.
//!
//! ```text
//! X_λ = [unscattered] p_uni,λ/Σ_h w_h p_uni,h + Σ over shadow rays and the hit  f_λ/Σ_h w_h (p_uni,h + p_nee,h)
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `hero` | distribution of the hero: `"uniform"`, `"luminance"`, or a list of probabilities that sum to 1 | `"uniform"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel, the same in all or not | required here or in the case |
//!
//! This is Algorithm 2 of the source, corrected. The transmittance of the last piece is in f and in both densities.
//! The samples of both techniques are added, so that the sum of their densities is not averaged over both. Hits are
//! divided by the same sum, with `p_nee` from the last real scattering on and `p_nee = 0` before the first. The
//! phase function is that of each channel. The whole path has one hero, shadow rays too.
//!
//! With one channel it is `full-mis`. The variance is known where all channels have the same σ_t and σ̂;
//! elsewhere it is bounded, see [`theory::rod::lit::spectral::bound`].
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), sections 5.3 and 5.4, Algorithms 1 and 2.
//!
//! ```toml
//! title = "An example of next-event-mis"
//!
//! [problem.rod]
//! medium = [1.1, 1, 0.9]
//! span = [0, 2]
//! albedos = [0.8, 0.75, 0.7]
//! forward = [0.75, 0.75, 0.75]
//! light = "emitter"
//! sampling = 1.6
//! estimators = ["next-event-mis"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::page::HeroMis;

/// The balance heuristic over heroes and both techniques.
pub type NextEventMis = HeroMis<true>;

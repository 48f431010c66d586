//! Delta tracking through a slab with the albedo as a weight, for any σ̂.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0; refused where the variance is infinite.
//!
//! ```text
//! D = |r| + |1 − r|,  r = σ_t/σ̂
//! scattered with probability |r|/D and weight a sgn(r) D w, straight on with |1 − r|/D and sgn(1 − r) D w
//! ```
//!
//! It takes σ̂ and no settings. Where `σ̂ ≥ σ_t` a collision is real with probability r, and then the weight is
//! multiplied by a: `E[X^k]` is the energy of the same slab with the albedo `a^k`, whatever σ_t and σ̂. Below σ_t,
//! probabilities and weights are those of weighted delta tracking. The variance may be infinite: then the estimator
//! is refused.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light transport*, ACM
//! Transactions on Graphics 38 (2019), section 5.2; the probabilities below σ_t: M. Galtier et al., *Integral
//! formulation of null-collision Monte Carlo algorithms*, Journal of Quantitative Spectroscopy and Radiative
//! Transfer 125 (2013).
//!
//! ```toml
//! title = "An example of weighted"
//!
//! [problem.slab]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.8
//! phase = "isotropic"
//! incidence.collimated.cosine = 0.6
//! sampling = 1.6
//! estimators = ["weighted"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::rod::weighted::Weighted;

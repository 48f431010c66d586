//! The single particle model that never ends inside a slab: what is absorbed is weight.
//!
//! Unbiased for: every σ̂ > 0 where σ_t ≠ 0; refused where the variance is infinite.
//!
//! ```text
//! D = a|r| + |1 − r|,  r = σ_t/σ̂
//! scattered with chance a|r|/D and weight sgn(r) D w, straight on with |1 − r|/D and sgn(1 − r) D w
//! ```
//!
//! It takes σ̂ and no settings, and exists for every σ̂ that is positive where σ_t is. Where `σ̂ ≥ σ_t`
//! the weight `D = 1 − (1 − a) r` never exceeds 1. Below, it grows at every collision, and light that
//! travels along the layers has no end of them: where `(r − 1) D ≥ 1`, or the slab is too thick for what
//! is scattered, the variance is infinite, and the walk is refused.
//!
//! Under diffuse light from above and from below alike, the mean number of lookups is `2∫σ̂ dz` whatever
//! the medium: the mean chord of the slab times the mean σ̂.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! sections 3.2 and 3.3, Eq. 12.

pub use crate::rod::non_terminating::NonTerminating;

//! A particle that walks from the eye until it meets the light: no shadow rays.
//!
//! Unbiased for: σ̂ ≥ σ_t and a light that a walk can meet; refused elsewhere.
//!
//! ```text
//! X = w where the walk ends on the light, 0 where it ends elsewhere
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule` | `terminating`, `non-terminating`, `adaptive`, `analog` or `weighted` | required |
//! | `roulette` | w₀ in (0, 1]: a walk with a smaller weight goes on with chance abs(w)/w₀ and weight w₀ | none |
//!
//! An environment is met where the particle leaves the ball, a black sphere where it meets that; a distant
//! light is never met, and is refused. Unbiased for every σ̂; needed is `σ̂ ≥ σ_t`, for which a draw lies in
//! [0, 1] and its variance is at most `L(1 − L)`. By the rules analog and terminating it is 1 with chance L,
//! else 0, and all of its law is known; of the others no more than the bound. The number of lookups is not
//! known.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.1, `SimulateParticle`.

pub use crate::space::Walker;

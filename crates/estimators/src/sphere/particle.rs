//! A particle that walks from the eye until it hits the light: no shadow rays.
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
//! | `roulette` | w₀ in (0, 1]: a walk with a smaller weight goes on with probability abs(w)/w₀ and weight w₀ | none |
//!
//! An environment is hit where the particle leaves the ball, a black sphere where the particle reaches it. A
//! distant light is never hit, and is refused. Unbiased for every σ̂. Required is `σ̂ ≥ σ_t`, for which a draw lies
//! in [0, 1] and its variance is at most `L(1 − L)`. By the rules analog and terminating a draw is 1 with
//! probability L, else 0, so that its distribution is known. For the other rules only the bound is known. The
//! number of lookups is not known.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.1, `SimulateParticle`.
//!
//! ```toml
//! title = "An example of particle"
//!
//! [problem.ball]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0.2, 0, -2], direction = [0, 0, 1] }
//! albedo = 0.8
//! phase = "isotropic"
//! light.black-sphere.radius = 0.5
//! sampling = 1.6
//! estimators = [{ particle.rule = "weighted" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::space::Walker;

//! A particle that walks into a furnace by one of the rules of the single particle model.
//!
//! Unbiased for: r ≤ 1 by the rule `analog`, r ≤ 2/(a + 1) by `terminating`, and by the others as long as theory
//! bounds the variance; refused elsewhere.
//!
//! ```text
//! X = Σ w r (1 − a) over its tentative collisions + w where it leaves,   E[X] = 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule` | `terminating`, `non-terminating`, `adaptive`, `analog` or `weighted` | required |
//! | `roulette` | w₀ in (0, 1]: a walk with a smaller weight goes on with probability abs(w)/w₀ and weight w₀ | none |
//!
//! | rule | exists for | a draw for `σ̂ ≥ σ_t` |
//! |---|---|---|
//! | non-terminating, adaptive | every r | is 1: what is lost as weight is scored |
//! | terminating, analog | `r ≤ 2/(a + 1)`, `r ≤ 1` | has a variance of 1 at most |
//! | weighted | every r | has a variance of (1 − a)/(1 + a) at most |
//!
//! Below σ_t weights may grow. Up to `r < 2/(a + 1)` theory bounds the variance, and in thin volumes beyond;
//! elsewhere the walk is refused. Roulette has a bound for `σ̂ ≥ σ_t` only. The bound is w₀² if draws are 1 without
//! roulette. The number of lookups is not known.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.1, `SimulateParticle`; the bounds are derived in `theory/space.rs`.
//!
//! ```toml
//! title = "An example of particle"
//!
//! [problem.furnace]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedo = 0.8
//! phase = "isotropic"
//! sampling = 1.2
//! estimators = [{ particle.rule = "weighted" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::space::Walker;

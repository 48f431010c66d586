//! A particle that walks from a point source by one of the rules of the single particle model.
//!
//! Unbiased for: r ≤ 2/(a + 1) by the rule `terminating`, σ̂ ≥ σ_t by the others; refused elsewhere.
//!
//! ```text
//! collisions within R: Σ w r [x < R],  squared distance Σ w r (1 − a) x²,  collisions Σ w r
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule` | `terminating`, `non-terminating`, `adaptive`, `analog` or `weighted` | required |
//! | `roulette` | w₀ in (0, 1]: a walk with a smaller weight goes on with probability abs(w)/w₀ and weight w₀ | required for rules that never end |
//!
//! `terminating` exists for `r ≤ 2/(a + 1)`, `analog` for `σ̂ ≥ σ_t`. The other rules end only by roulette, and are
//! refused below σ_t, where weights grow. The lookups of the first two are geometric; so are their collisions for
//! `σ̂ ≥ σ_t`, with all their moments known.
//!
//! Source: L. Szirmay-Kalos et al. 2017, section 4.1, `SimulateParticle`.
//!
//! ```toml
//! title = "An example of particle"
//!
//! [problem.infinite-medium]
//! volume = 1
//! ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 1 }
//! albedo = 0.7
//! phase.henyey-greenstein.g = 0.6
//! sampling = 1.2
//! estimators = [{ particle.rule = "analog" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::space::Walker;

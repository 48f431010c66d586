//! A particle that enters a body from all sides and walks by one of the rules of the single particle
//! model.
//!
//! Unbiased for: whatever it is unbiased for in a furnace; refused where no channel has a known mean and spread.
//!
//! ```text
//! place even over the boundary, cosine with the inward normal √u, azimuth even
//! energy Σ w r (1 − a) + w,  path length Σ w ℓ,  collisions Σ w r,  tentative collisions Σ 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule` | `terminating`, `non-terminating`, `adaptive`, `analog` or `weighted` | required |
//! | `roulette` | w₀ in (0, 1]: a walk with a smaller weight goes on with probability abs(w)/w₀ and weight w₀ | none |
//!
//! Unbiased as in a furnace. It is refused where none of its channels has both a known mean and a known variance or
//! light tails. The path of the non-terminating rule does not depend on the weight: its number of tentative
//! collisions, which is that of its lookups, is known for any σ̂, also far below σ_t.
//!
//! Source: L. Szirmay-Kalos et al. 2017, section 4.1, `SimulateParticle`; A. Mazzolo, C. de Mulatier, A.
//! Zoia, *Cauchy's formulas for random walks in bounded domains*, Journal of Mathematical Physics 55
//! (2014).
//!
//! ```toml
//! title = "An example of particle"
//!
//! [problem.lambertian]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedo = 1
//! phase = "isotropic"
//! sampling = 1.2
//! estimators = [{ particle.rule = "terminating" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::space::Walker;

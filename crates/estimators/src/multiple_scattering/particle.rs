//! A particle that walks from the camera by one of the rules of the single particle model, and gathers the
//! sky where it leaves: `SimulateParticle` with importons.
//!
//! Unbiased for: r ≤ 1 by the rule `analog`, r ≤ 2/(a + 1) by `terminating`, every r by the others.
//!
//! ```text
//! X = w L_sky(d')  where it leaves in the direction d',   0 where it is absorbed
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule` | `terminating`, `non-terminating`, `adaptive`, `analog` or `weighted` | required |
//! | `roulette` | w₀ in (0, 1]: a walk with a smaller weight goes on with probability abs(w)/w₀ and weight w₀ | none |
//!
//! Unbiased where the rule exists: `terminating` for `r ≤ 2/(a + 1)`, `analog` for `r ≤ 1`, the others
//! for every `r = σ_t/σ̂`. Far below σ_t the variance may be infinite: `trueflight explain furnace`.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.1, `SimulateParticle`.
//!
//! ```toml
//! title = "An example of particle"
//!
//! [picture.multiple-scattering]
//! size = [32, 32]
//! lookups = 50
//! volume.eq21 = {}
//! albedo = 1
//! phase = "isotropic"
//! camera = { position = [0, 0, -22], target = [0, 0, 10], angle = 38 }
//! reference.closed-form = {}
//! sampling = 1
//! estimators = [{ particle.rule = "non-terminating" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!(picture))]

pub use crate::space::Walker;

//! A particle that splits on its way from the camera: the transmitted and the scattered particle are both tracked,
//! up to a bound; then one of them, by a rule.
//!
//! Unbiased for: r ≤ 1 by the rule `analog`, r ≤ 2/(a + 1) by `terminating`, every r by the others.
//!
//! ```text
//! at a collision that splits: w → (1 − r) w straight on, and a r w into a new direction
//! X = Σ w L_sky(d') over all that leaves
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `depth` | maximum number of splits on any path from the start: 2ⁿ particles at most, n ≤ 10 | one of the two |
//! | `budget` | maximum number of splits in a walk: n + 1 particles at most | is required |
//! | `rule` | what happens then, as in `particle` | required |
//! | `roulette` | as in `particle` | none |
//!
//! Source: L. Szirmay-Kalos et al. 2017, section 3 (the double particle model).
//!
//! ```toml
//! title = "An example of splitting"
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
//! estimators = [{ splitting = { rule = "analog", depth = 2 } }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!(picture))]

pub use crate::space::Splitter;

//! A particle that enters a body from all sides and splits: the transmitted and the scattered particle are both
//! tracked, up to a bound; then one of them, by a rule.
//!
//! Unbiased for: whatever it is unbiased for in a furnace; refused where no channel has a known mean and spread.
//!
//! ```text
//! at a collision that splits: w → (1 − r) w straight on, and a r w into a new direction
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `depth` | maximum number of splits on any path from the start: 2ⁿ particles at most, n ≤ 10 | one of the two |
//! | `budget` | maximum number of splits in a walk: n + 1 particles at most | is required |
//! | `rule` | what happens then, as in `particle` | required |
//!
//! Its channels are those of `particle` without the tentative collisions.
//!
//! Source: L. Szirmay-Kalos et al. 2017, section 3 (the double particle model).
//!
//! ```toml
//! title = "An example of splitting"
//!
//! [problem.lambertian]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedo = 1
//! phase = "isotropic"
//! sampling = 1.2
//! estimators = [{ splitting = { rule = "analog", depth = 2 } }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::space::Splitter;

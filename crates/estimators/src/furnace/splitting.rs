//! A particle that splits in a furnace: the transmitted and the scattered particle are both tracked, up to a bound;
//! then one of them, by a rule.
//!
//! Unbiased for: r ≤ 1 by the rule `analog`, r ≤ 2/(a + 1) by `terminating`, and by the others as long as theory
//! bounds the variance; refused elsewhere.
//!
//! ```text
//! at a collision that splits: w → (1 − r) w straight on, and a r w into a new direction
//! X = Σ w r (1 − a) over all tentative collisions + Σ w over all that leaves,   E[X] = 1
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `depth` | maximum number of splits on any path from the start: 2ⁿ particles at most, n ≤ 10 | one of the two |
//! | `budget` | maximum number of splits in a walk: n + 1 particles at most | is required |
//! | `rule` | what happens then, as in `particle` | required |
//!
//! It is the double particle of the rod and the slab, in space: without a bound its number of particles grows with
//! every collision. A split is the expectation of every rule over the events at the collision, so that splits add
//! no variance. Particles of negative weight are tracked like all others.
//!
//! Source: L. Szirmay-Kalos et al. 2017, section 3 (the double particle model); the bound on the number of
//! particles is that of any renderer that splits.
//!
//! ```toml
//! title = "An example of splitting"
//!
//! [problem.furnace]
//! volume.constant = { extinction = 1, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
//! ray = { origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }
//! albedo = 0.8
//! phase = "isotropic"
//! sampling = 1.2
//! estimators = [{ splitting = { rule = "analog", depth = 3 } }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

pub use crate::space::Splitter;

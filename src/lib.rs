//! Trueflight.
pub mod catalogue;
pub mod estimators;
pub mod geometry;
pub mod harness;
pub mod media;
pub mod numeric;
pub mod problems;
pub mod rng;
pub mod stats;
pub mod theory;

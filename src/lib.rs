//! Trueflight.
pub mod catalogue;
pub mod geometry;
pub mod harness;
pub mod media;
pub mod numeric;
pub mod report;
pub mod rng;

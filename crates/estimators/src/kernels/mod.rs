//! Kernels: loops that make draws, whatever the estimator. Floor 4.
//!
//! [`walk`] and [`scoring`] go from collision to collision, one draw at a time; [`packet`] lets sixteen of these walks fly,
//! look up and collide together, and is the particle bank of walks that take as many random numbers as they need;
//! [`order_free`] takes all walks of a request through one collision after the other. What happens at a collision is
//! the estimator's. [`hero`] is what a path scores in each channel of a chromatic medium, whoever walked it.

pub mod draw;
pub mod hero;
pub mod order_free;
pub mod packet;

pub use draw::{Draw, DrawBuffer};

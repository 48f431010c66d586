//! Kernels: loops that make draws, whatever the estimator. Floor 4.
//!
//! Walks along a line are in [`crate::walks`]. [`packet`] has the packets of chromatic media and of bidirectional paths, and
//! the slots of particle banks. [`hero`] is the score of a path in each channel of a chromatic medium.

pub mod draw;
pub mod hero;
pub mod packet;

pub use draw::{Draw, DrawBuffer};

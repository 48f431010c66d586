//! Kernels: loops that make draws, whatever the estimator. Floor 4.
//!
//! Walks along a line are in [`crate::walks`]. [`packet`] has the slots of particle banks, and the packets of walks in space with
//! channels. [`hero`] is the score of their paths in each channel.

pub mod draw;
pub mod hero;
pub mod packet;

pub use draw::{Draw, DrawBuffer};

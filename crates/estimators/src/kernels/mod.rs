//! Draws, their buffers, and the slots in which packs of walks write them.

pub mod bank;
pub mod draw;

pub use draw::{Draw, DrawBuffer, Request};

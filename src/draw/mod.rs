//! Draws: blocks, looks of the gate, and the stores that keep what was drawn.

pub mod block;
pub mod blocks;
pub mod cache;
pub mod drawn;
mod frames;
pub mod progress;
pub mod run;
pub mod share;
pub mod store;
pub mod workers;

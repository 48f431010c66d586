//! Draws: blocks, looks of the gate, and the stores that keep what was drawn.

pub mod block;
pub mod run;
pub mod share;
pub mod store;

//! Draws: blocks, looks of the gate, and the stores that keep what was drawn.

pub mod block;
pub mod drawn;
pub mod progress;
pub mod run;
pub mod share;
pub mod store;
pub mod workers;

//! Statistics that have never heard of light. Floor 1.

pub mod catoni;
pub mod chi_square;
pub mod gate;
pub mod normal;
pub mod tally;

pub use tally::{Moments2, Tally};

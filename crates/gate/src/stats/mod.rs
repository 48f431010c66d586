//! Statistics that have never heard of light. Floor 1.

pub mod anderson_darling;
pub mod betting;
pub mod binomial;
pub mod capital;
pub mod catoni;
pub mod census;
pub mod chi_square;
pub mod correlation;
pub mod estimated_variance;
pub mod gate;
pub mod independence;
pub mod multiplicity;
pub mod normal;
pub mod powers;
pub mod reflection;
pub mod replays;
pub mod runs;
pub mod sequences;
pub mod symmetric;
pub mod tally;
pub mod ties;
pub mod verdict;

pub use census::Census;
pub use powers::Powers;
pub use tally::{Moments2, Tally};

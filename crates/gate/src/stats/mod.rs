//! Statistics that have never heard of light. Floor 1.

pub mod anderson_darling;
pub(crate) mod betting;
pub mod binomial;
pub mod capital;
pub mod catoni;
mod census;
pub mod chi_square;
pub mod correlation;
pub mod estimated_variance;
pub mod gate;
pub mod independence;
pub mod multiplicity;
pub mod normal;
mod powers;
pub mod reflection;
pub(crate) mod replays;
pub(crate) mod runs;
pub(crate) mod sequences;
pub mod symmetric;
mod tally;
pub mod ties;
pub mod verdict;

pub use census::Census;
pub use powers::Powers;
pub use tally::{Moments2, Tally};

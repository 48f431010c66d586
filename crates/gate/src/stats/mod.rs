//! Statistics: evidence on means, and tests of independence, repetition and distributions.

#[cfg(feature = "distributions")]
pub mod anderson_darling;
pub(crate) mod betting;
#[cfg(feature = "distributions")]
pub mod binomial;
pub mod capital;
pub mod catoni;
#[cfg(feature = "distributions")]
pub mod chi_square;
#[cfg(feature = "distributions")]
pub mod correlation;
pub mod estimated_variance;
pub mod gate;
pub mod independence;
pub mod multiplicity;
#[cfg(feature = "distributions")]
pub mod normal;
mod powers;
pub(crate) mod replays;
pub(crate) mod sequences;
mod tally;
pub mod ties;
pub mod verdict;

pub use powers::Powers;
pub use tally::{Census, Moments2, Tally};

//! Is my estimator unbiased? Statistics and verdicts for draws of any program.

pub mod causes;
pub mod check;
pub mod check_id;
pub mod deviation;
#[cfg(feature = "serde")]
pub mod extended;
pub mod session;
pub mod stats;

pub use numeric::rng;

pub use check_id::CheckId;

pub use check::{Check, Gate, check, check_with, claim};

/// Compiles the example of the manual that needs this crate only.
#[cfg(doctest)]
#[doc = include_str!("../docs/first-bug.md")]
struct FirstBug;

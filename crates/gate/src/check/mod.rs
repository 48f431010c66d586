//! Is my estimator unbiased? Three lines in one's own test. Floor 7.
//!
//! [`check`] draws from a closure, [`check_with`] from one closure a thread, and [`claim`] waits for draws that are
//! pushed. What a correct draw is like is said by numbers ([`Check::truth`], [`Check::variance`],
//! [`Check::kurtosis`], [`Check::range`]), or taken from theory for an experiment of a case (`Check::of`). Then the
//! gate of `trueflight judge` answers: pass, fail or inconclusive, and a correct estimator fails with chance α at
//! most. [`Gate`] shares one α among several checks.
//!
//! ```
//! // The transmittance of a homogeneous medium of depth 1: does a photon fly farther than 1?
//! trueflight_gate::check("analogue", |rng| f64::from(-rng.positive_uniform().ln() > 1.0))
//!     .truth((-1.0f64).exp())
//!     .range(0.0, 1.0)
//!     .assert_pass();
//! ```
//!
//! Draws come in blocks of 2¹⁴, and each block has a random stream of its own, addressed by seed, name and block: a
//! closure that uses no other source of chance makes the same draws on any number of threads. Without
//! [`Check::draws`] they end as soon as all is decided, and after [`MOST`] draws at the latest.

mod builder;
mod error;
mod gate;
mod made;
mod outcome;
mod property;
mod pushed;
mod said;
mod sample;

pub use builder::{Check, MAX_VALUES, MOST, Values, check, check_with, claim};
pub use error::CheckError;
pub use gate::{Gate, Planned};
pub use made::{Closure, Factory};
pub use outcome::Outcome;
pub use property::Property;
pub use pushed::{Pushed, Request};
pub use sample::Sample;

pub use crate::session::{Block, Source, Stop, Until};

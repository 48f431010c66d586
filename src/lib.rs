//! Is my estimator unbiased, and is its variance what theory says? Three lines in a test of one's own:
//!
#![cfg_attr(feature = "library", doc = "```")]
#![cfg_attr(not(feature = "library"), doc = "```ignore")]
//! # use trueflight::rng::Stream;
//! # fn sigma_t(t: f64) -> f64 {
//! #     (0.75 * t).cos().powi(10) * ((t / 2.0).sin() + 2.0) / 3.0
//! # }
//! # fn my_estimator(rng: &mut Stream) -> f64 {
//! #     let (mut weight, mut t) = (1.0, -rng.positive_uniform().ln());
//! #     while t < 20.0 {
//! #         weight *= 1.0 - sigma_t(t);
//! #         t -= rng.positive_uniform().ln();
//! #     }
//! #     weight
//! # }
//! trueflight::check("ratio tracking, Eq. 21", |rng| my_estimator(rng))
//!     .of("transmittance/eq21-overview", "ratio", 1.0)
//!     .assert_pass();
//! ```
//!
//! [`check`](fn@check) draws from the closure until all is decided, compares mean, variance and lookups with what
//! theory says of this experiment, and panics with the reason unless they agree; a correct estimator fails with
//! chance 0.001 at most. Without a case, [`Check::truth`], [`Check::variance`] and [`Check::range`] say what is
//! known. [`claim`] judges draws that come from elsewhere, [`Gate`] shares one error rate among several checks.
//!
//! Trueflight proves that a light-transport estimator is fair. It drives null-collision Monte Carlo estimators of
//! transmittance, free flight and scattering in heterogeneous media through millions of draws, compares every mean,
//! variance, cost and law with what theory predicts, and says *pass*, *fail* or *inconclusive*. `Catalogue` takes
//! media and estimators of one's own, and `cli::main` makes a command of them.
//!
//! # The house
//!
//! A module uses only floors strictly below its own; modules on one floor do not know each other.
//!
//! ```text
//! 8  cli            arguments, exit codes, progress, the only prints
//! 7  report         record → artifacts: csv, json, svg, png, console, junit, markdown
//!    check          somebody's own estimator: closures and pushed draws against the gate
//! 6  baseline judge bench stress self_test render export   programs that use the harness; they do not know each other
//! 5  harness        case → plan → run → verdict → record: the only place where names become types
//! 4  estimators     draws, one page each; beside them their mutants, each with one known bug
//! 3  theory         moments and costs in closed form; never draws a random number
//! 2  problems       what is sought; each integral knows its truth
//! 1  media   phase   stats  neighbours that have never met
//! 0  numeric geometry rng catalogue files     know nothing of light
//! ```
//!
//! # Invariants
//!
//! - `stats` has never heard of media; `media` has never heard of statistics.
//! - `theory` contains no generator; `estimators` contain no tolerance; `report` does no arithmetic
//!   beyond formatting and sees only the record.
//! - An estimator is data: no interior mutability, one value serves every thread.
//! - Every random number has an address (seed, experiment, block, lane). Thread count, shard and
//!   machine are no part of it, and results merge in address order: the *results* part of a record
//!   is byte-identical on any number of threads. A run limited by time is exempt, and says so.
//! - What a draw computes (ln, exp, cos) comes from [`numeric::elementary`], never from the
//!   platform's library.
//! - No number is compared with a prediction more strictly than the prediction's own error bound.
//! - Nothing is clamped, skipped or defaulted silently. Unknown is `None`, never `0`.
//! - A check that cannot fail is a defect.

#[cfg(feature = "library")]
pub mod baseline;
#[cfg(feature = "library")]
pub mod bench;
pub mod catalogue;
pub mod check;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "library")]
pub mod estimators;
#[cfg(feature = "library")]
pub mod export;
#[cfg(feature = "library")]
pub mod files;
#[cfg(feature = "library")]
pub mod geometry;
#[cfg(feature = "library")]
pub mod harness;
pub mod judge;
#[cfg(feature = "library")]
pub mod kernels;
#[cfg(feature = "library")]
pub mod media;
#[cfg(feature = "library")]
pub mod mutants;
pub mod numeric;
#[cfg(feature = "library")]
pub mod phase;
#[cfg(feature = "library")]
pub mod problems;
#[cfg(feature = "library")]
pub mod recipes;
#[cfg(feature = "library")]
pub mod render;
#[cfg(feature = "cli")]
pub mod report;
pub mod rng;
#[cfg(feature = "library")]
pub mod self_test;
#[cfg(feature = "library")]
pub mod setup;
pub mod stats;
#[cfg(feature = "library")]
pub mod stress;
#[cfg(feature = "library")]
pub mod theory;

pub use check::{Check, Gate, check, check_with, claim};
#[cfg(feature = "library")]
pub use harness::Catalogue;

/// The examples of README and manual are compiled and run with the documentation's.
#[cfg(all(doctest, feature = "cli"))]
mod manual {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[doc = include_str!("../docs/library.md")]
    struct Library;
    #[doc = include_str!("../docs/extending.md")]
    struct Extending;
}

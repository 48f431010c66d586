//! Is my estimator unbiased, and is its variance what theory says? Three lines in a test of one's own:
//!
//! ```
//! use trueflight::OfCase;
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

pub mod bench;
pub mod case;
pub mod checks;
pub mod cli;
pub mod draw;
pub mod export;
pub mod judge;
pub mod plan;
pub mod record;
pub mod render;
pub mod report;
pub mod self_test;

pub use ::{estimators, gate, lab, media, numeric, theory};
pub use case::Catalogue;
pub use estimators::{kernels, recipes, setup};
pub use gate::stats;
pub use gate::{Check, Gate, check, check_with, claim};
pub use judge::OfCase;
pub use lab::{mutants, stress};
pub use media::{catalogue, files, page, phase};
pub use numeric::{geometry, rng};
pub use theory::problems;

/// The examples of README and manual are compiled and run with the documentation's.
#[cfg(doctest)]
mod manual {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[doc = include_str!("../docs/library.md")]
    struct Library;
    #[doc = include_str!("../docs/extending.md")]
    struct Extending;
}

//! Tests whether an estimator is unbiased and as noisy as theory says, in three lines of a test:
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
//! [`check`](fn@check) draws from the closure until all is decided, compares mean, variance and lookups with
//! theory's prediction of this experiment, and panics with the reason unless they agree. A correct estimator fails with
//! probability 0.001 at most.
//!
//! | I want to | item |
//! |---|---|
//! | test my estimator, and know its exact mean | [`check`](fn@check) with [`Check::truth`], [`Check::range`], [`Check::variance`] |
//! | compare it with one of the cases | [`OfCase::of`] |
//! | test it on all processors | [`check_with`] |
//! | judge draws that I have already | [`claim`], then [`gate::check::Pushed::absorb`] |
//! | share one error rate among several checks | [`Gate`] |
//! | judge images of a renderer | [`judge::images`] |
//! | predict mean, variance and cost of an estimator | [`plan::Plan`], then [`record::build`] |
//! | draw and judge a case | [`case::Case::read`], [`plan::Plan::new`], [`draw::run`], [`record::build::judged`] |
//! | make the draws of a case, and nothing else | [`case::Case::at`], [`case::ScenarioAtPoint::draws`] |
//! | write tables, plots and the page of a run | [`report`] |
//! | look σ_t or an optical depth up | [`media`] |
//! | add a medium or an estimator, for cases, too | [`Catalogue`], [`media::own`], [`estimators::own`] |
//! | give my program all commands | [`cli::main`] |
//! | find the reason of a failure | [`gate::causes`] |
//!
//! Trueflight makes millions of draws of null-collision Monte Carlo estimators of transmittance, free flight and
//! scattering in heterogeneous media. It compares every mean, variance, cost and distribution with exact theory, and
//! says *pass*, *fail* or *inconclusive*. A program adds media and estimators of its own to a `Catalogue`, and gets a
//! command for them by `cli::main`.
//!
//! # Invariants
//!
//! - `stats` does not depend on `media`, nor `media` on `stats`.
//! - `theory` contains no generator; `estimators` contain no tolerance; `report` does no arithmetic beyond formatting
//!   and sees only the record.
//! - An estimator is data: no interior mutability, one value serves every thread.
//! - Every random number has an address (seed, experiment, block, lane), whatever the number of threads, the shard and
//!   the machine. Results merge in address order: the *results* part of a record is byte-identical on any number of
//!   threads. A run limited by time is exempt, and says so.
//! - Elementary functions in a draw (ln, exp, cos) come from [`numeric::elementary`], never from the platform's
//!   library.
//! - No number is compared with a prediction more strictly than the prediction's own error bound.
//! - Nothing is clamped, skipped or defaulted silently. Unknown is `None`, never `0`.
//! - A check that cannot fail is a defect.

pub mod advise;
pub mod bench;
pub mod case;
pub mod cli;
pub mod draw;
pub mod export;
mod json;
pub mod judge;
pub mod plan;
pub mod record;
pub mod render;
pub mod report;

pub use ::{checks, drawing, estimators, gate, media, numeric, theory};
pub use case::Catalogue;
pub use estimators::{recipes, setup};
pub use gate::stats;
pub use gate::{Check, Gate, check, check_with, claim};
pub use judge::OfCase;
pub use media::{catalogue, files, page, phase};
pub use numeric::{geometry, rng};
pub use theory::problems;

/// Compiles and runs the examples of README, manual and the pages of the catalogue with those of the documentation.
#[cfg(doctest)]
mod manual {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[doc = include_str!("../docs/library.md")]
    struct Library;
    #[doc = include_str!("../docs/extending.md")]
    struct Extending;
    #[doc = media::draw_in_rust!()]
    struct DrawnCase;
    #[doc = media::draw_in_rust!(picture)]
    struct RenderedPicture;
}

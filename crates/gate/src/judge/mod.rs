//! Draws that another program made: whether they are what they are claimed to be.
//!
//! A [`claim::Claim`] says what is known of a draw: its mean and, if known, its variance, kurtosis and range. A
//! [`trial::Trial`] judges draws in memory, or in `files` of several formats. Without the feature
//! `library` this room and [`crate::stats`] are all of the crate: enough for a test of somebody's estimator.
//!
//! ```
//! use trueflight_gate::judge::claim::{Claim, Given};
//! use trueflight_gate::judge::trial::{Trial, Wanted};
//! use trueflight_gate::stats::verdict::Verdict;
//!
//! // Draws of a fair coin, claimed to be 0.5 on average and to lie in [0, 1].
//! let mut state = 1u64;
//! let draws: Vec<f64> = (0..400_000)
//!     .map(|_| {
//!         state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
//!         f64::from(u8::from(state >> 63 == 1))
//!     })
//!     .collect();
//! let claim = Claim::new(&Given { truth: 0.5, range: Some([0.0, 1.0]), ..Given::default() })?;
//! let trial = Trial::new(claim, Wanted::default(), Some(draws.len() as u64))?;
//! assert_eq!(trial.judge_all(&draws).verdict, Verdict::Pass);
//! # Ok::<(), trueflight_gate::judge::claim::ClaimError>(())
//! ```

pub mod asks;
pub mod claim;
pub mod contents;
pub mod dependence;
pub mod finding;
pub mod flights;
pub mod grounds;
pub mod judgement;
pub mod likely;
pub mod obvious;
pub mod reading;
pub mod scalar;
pub mod theory;
pub mod trial;
pub mod values;
pub mod verdict;
pub mod words;

//! A σ̂ that is constant between breaks.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `breaks` | ascending distances along the ray, n + 1 of them | length |
//! | `values` | σ̂ ≥ 0 between them, n of them | 1/length |
//!
//! Outside the breaks the first and the last value go on. Free flight inverts the piecewise optical
//! depth exactly.
//!
//! ```toml
//! title = "An example of piecewise-constant"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling.piecewise-constant = { breaks = [0, 1, 5], values = [1.6, 0.8] }
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

/// A piecewise-constant σ̂.
pub type PiecewiseConstant = super::piecewise_linear::Given<true>;
